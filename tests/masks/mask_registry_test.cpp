// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/masks/mask_registry.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

struct Seen {
  int observed = 0;
  int nodes = 0;
  int restarts = 0;
};
Seen seen_by_counting;

class CountingMask : public Mask {
 public:
  void Observe(const MaskObservation& /*observation*/) override { ++seen_by_counting.observed; }
  bool Fires() const override { return false; }
  void OnNode() override { ++seen_by_counting.nodes; }
  void Restart() override { ++seen_by_counting.restarts; }
};

const bool kRegistered =
    RegisterMask("counting", [](const MaskOptions&) { return std::make_unique<CountingMask>(); });

bool FiresFor(const std::string& expression) { return MakeMask(expression, {})->Fires(); }

std::string ErrorOf(const std::string& expression) {
  try {
    MakeMask(expression, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MaskRegistry, KnowsBuiltInAndUserMasks) {
  EXPECT_TRUE(kRegistered);
  EXPECT_EQ(RegisteredMasks(),
            (std::vector<std::string>{"always", "counting", "eccentricity", "never", "openings"}));
  for (const std::string& name : RegisteredMasks()) EXPECT_NE(MakeMask(name, {}), nullptr);
}

TEST(MaskRegistry, RefusesBadNames) {
  const MaskFactory factory = [](const MaskOptions&) { return std::make_unique<CountingMask>(); };
  for (const char* name :
       {"", "any", "all", "not", "sparse", "Upper", "with space", "a(b", "never"}) {
    EXPECT_THROW(RegisterMask(name, factory), std::logic_error) << name;
  }
}

TEST(MaskExpression, TruthTables) {
  const std::string f = "never";
  const std::string t = "always";
  EXPECT_FALSE(FiresFor(f));
  EXPECT_TRUE(FiresFor(t));
  EXPECT_TRUE(FiresFor("not(" + f + ")"));
  EXPECT_FALSE(FiresFor("not(" + t + ")"));
  for (const bool a : {false, true}) {
    EXPECT_EQ(FiresFor("any(" + (a ? t : f) + ")"), a);
    EXPECT_EQ(FiresFor("all(" + (a ? t : f) + ")"), a);
    for (const bool b : {false, true}) {
      const std::string two = "(" + (a ? t : f) + "," + (b ? t : f) + ")";
      EXPECT_EQ(FiresFor("any" + two), a || b) << two;
      EXPECT_EQ(FiresFor("all" + two), a && b) << two;
      for (const bool c : {false, true}) {
        const std::string third = c ? t : f;
        EXPECT_EQ(FiresFor("any(" + third + ",all" + two + ")"), c || (a && b));
        EXPECT_EQ(FiresFor("all(not(" + third + "),any" + two + ")"), !c && (a || b));
      }
    }
  }
}

TEST(MaskExpression, SpacesDoNotMatter) { EXPECT_TRUE(FiresFor("  any ( never ,\talways )  ")); }

TEST(MaskExpression, EveryPartSeesEverything) {
  seen_by_counting = {};
  const auto mask = MakeMask("any(always,all(never,not(counting)))", {});
  const LaserScan scan;
  for (int i = 0; i < 3; ++i) mask->Observe({scan, {}});
  mask->OnNode();
  mask->Restart();
  EXPECT_EQ(seen_by_counting.observed, 3);
  EXPECT_EQ(seen_by_counting.nodes, 1);
  EXPECT_EQ(seen_by_counting.restarts, 1);
}

TEST(MaskExpression, ErrorsSayWhatAndWhere) {
  EXPECT_EQ(ErrorOf("openingz"), "unknown mask `openingz` (did you mean `openings`?)");
  EXPECT_EQ(ErrorOf("Openings"), "unknown mask `Openings` (did you mean `openings`?)");
  EXPECT_EQ(ErrorOf("any(never,eccentrisity)"),
            "unknown mask `eccentrisity` (did you mean `eccentricity`?)");
  EXPECT_EQ(ErrorOf("ani(never)"), "unknown mask `ani` (did you mean `any`?)");
  EXPECT_EQ(ErrorOf("xyzzy"),
            "unknown mask `xyzzy` (there are always, counting, eccentricity, never, openings, and "
            "any(...), all(...), not(...), sparse(...) of them)");
  EXPECT_EQ(ErrorOf(""), "mask expression, character 1: expected the name of a mask");
  EXPECT_EQ(ErrorOf("any"), "mask expression, character 4: expected `(` after `any`");
  EXPECT_EQ(ErrorOf("any()"), "mask expression, character 5: expected the name of a mask");
  EXPECT_EQ(ErrorOf("any(never"), "mask expression, character 10: expected `,` or `)`");
  EXPECT_EQ(ErrorOf("any(never,)"), "mask expression, character 11: expected the name of a mask");
  EXPECT_EQ(ErrorOf("never)"), "mask expression, character 6: expected the end");
  EXPECT_EQ(ErrorOf("never always"), "mask expression, character 7: expected the end");
  EXPECT_EQ(ErrorOf("never(always)"), "mask expression, character 6: `never` takes no parts");
  EXPECT_EQ(ErrorOf("not(never,never)"), "mask expression, character 16: `not` takes one part");
  EXPECT_EQ(ErrorOf("sparse(never,never)"),
            "mask expression, character 19: `sparse` takes one part");
}

TEST(MaskExpression, HostileInputIsRefused) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "not(";
  EXPECT_NE(ErrorOf(deep).find("nested deeper than"), std::string::npos);
  EXPECT_LT(ErrorOf(std::string(1000000, 'a')).size(), 200U);
  EXPECT_NE(ErrorOf(std::string("never\0", 6)), "");
}

}  // namespace
}  // namespace masked_mapper
