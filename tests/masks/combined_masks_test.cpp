// SPDX-License-Identifier: BSD-3-Clause
#include "masks/combined_masks.hpp"

#include <gtest/gtest.h>

#include "masks/never_always_masks.hpp"

namespace masked_mapper {
namespace {

struct Seen {
  int observed = 0;
  int nodes = 0;
  int restarts = 0;
};

class CountingMask : public Mask {
 public:
  CountingMask(bool fires, Seen& seen) : fires_(fires), seen_(seen) {}
  void Observe(const MaskObservation& /*observation*/) override { ++seen_.observed; }
  bool Fires() const override { return fires_; }
  void OnNode() override { ++seen_.nodes; }
  void Restart() override { ++seen_.restarts; }

 private:
  bool fires_;
  Seen& seen_;
};

std::vector<std::unique_ptr<Mask>> Parts(const std::vector<bool>& fire) {
  std::vector<std::unique_ptr<Mask>> parts;
  for (const bool fires : fire) {
    if (fires) {
      parts.push_back(std::make_unique<AlwaysMask>());
    } else {
      parts.push_back(std::make_unique<NeverMask>());
    }
  }
  return parts;
}

TEST(CombinedMasks, TruthTables) {
  for (const bool a : {false, true}) {
    EXPECT_EQ(NotMask(Parts({a})).Fires(), !a);
    EXPECT_EQ(AnyMask(Parts({a})).Fires(), a);
    EXPECT_EQ(AllMask(Parts({a})).Fires(), a);
    for (const bool b : {false, true}) {
      for (const bool c : {false, true}) {
        EXPECT_EQ(AnyMask(Parts({a, b, c})).Fires(), a || b || c);
        EXPECT_EQ(AllMask(Parts({a, b, c})).Fires(), a && b && c);
      }
    }
  }
}

TEST(CombinedMasks, EveryPartSeesEverythingWhateverTheOthersAnswer) {
  Seen first;
  Seen second;
  std::vector<std::unique_ptr<Mask>> parts;
  parts.push_back(std::make_unique<CountingMask>(true, first));
  parts.push_back(std::make_unique<CountingMask>(false, second));
  AnyMask mask(std::move(parts));
  const LaserScan scan;
  for (int i = 0; i < 3; ++i) mask.Observe({scan, {}});
  EXPECT_TRUE(mask.Fires());
  mask.OnNode();
  mask.Restart();
  for (const Seen& seen : {first, second}) {
    EXPECT_EQ(seen.observed, 3);
    EXPECT_EQ(seen.nodes, 1);
    EXPECT_EQ(seen.restarts, 1);
  }
}

}  // namespace
}  // namespace masked_mapper
