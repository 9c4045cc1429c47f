// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/option_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::string MessageOf(const std::string& assignment) {
  Options options;
  try {
    SetOption(assignment, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string TextOf(Options& options, const std::string& key) {
  for (const OptionEntry& entry : OptionTable(options)) {
    if (entry.key == key) return ValueText(entry);
  }
  return "no such key";
}

TEST(OptionTable, APersonCanReadIt) {
  Options options;
  const std::vector<OptionEntry> table = OptionTable(options);
  EXPECT_LE(table.size(), 45U);
  std::set<std::string> keys;
  for (const OptionEntry& entry : table) {
    EXPECT_TRUE(keys.insert(entry.key).second) << entry.key << " is listed twice";
  }
}

TEST(OptionTable, DefaultsAreAllowedAndFieldsAreDistinct) {
  Options options;
  std::set<const void*> fields;
  for (const OptionEntry& entry : OptionTable(options)) {
    const std::string text = ValueText(entry);
    EXPECT_NO_THROW(SetOption("test", entry.key, text, options)) << entry.key << '=' << text;
    std::visit(
        [&](const auto& field) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(field)>, Choice>) {
            EXPECT_TRUE(fields.insert(field).second) << entry.key << " shares its field";
          }
        },
        entry.field);
    EXPECT_FALSE(entry.help.empty()) << entry.key;
  }
  EXPECT_NO_THROW(CheckOptions(options));
}

TEST(OptionTable, EveryBoundIsAllowedAndReadsBackTheSame) {
  Options options;
  for (const OptionEntry& entry : OptionTable(options)) {
    std::visit(
        [&](const auto& field) {
          if constexpr (std::is_same_v<std::decay_t<decltype(field)>, Choice>) {
            for (const std::string& name : field.names) {
              SetOption("test", entry.key, name, options);
              EXPECT_EQ(ValueText(entry), name);
            }
          } else if constexpr (std::is_same_v<std::decay_t<decltype(field)>, std::string*>) {
            SetOption("test", entry.key, "/front,/rear", options);
            EXPECT_EQ(ValueText(entry), "/front,/rear");
            EXPECT_THROW(SetOption("test", entry.key, "\"", options), InputError);
          } else if constexpr (!std::is_same_v<std::decay_t<decltype(field)>, bool*>) {
            for (const double bound : {entry.min, entry.max}) {
              *field = static_cast<std::decay_t<decltype(*field)>>(bound);
              const std::string text = ValueText(entry);
              EXPECT_NO_THROW(SetOption("test", entry.key, text, options)) << entry.key;
              EXPECT_EQ(ValueText(entry), text);
            }
          }
        },
        entry.field);
  }
}

TEST(OptionTable, ChoicesAreSetByName) {
  Options options;
  SetOption("motion.source=scans", options);
  EXPECT_EQ(options.mapping.motion.source, MotionSource::kScans);
  EXPECT_EQ(MessageOf("motion.source=wheels"),
            "--set: motion.source must be auto, odometry, scans or fused, not `wheels`");
}

TEST(OptionTable, SetsOnlyWhatItNames) {
  Options options;
  const auto before = OptionValues(options);
  SetOption("matcher.min_score=0.5", options);
  SetOption("candidates.max_matches=+7", options);
  EXPECT_EQ(options.mapping.closures.matcher.min_score, 0.5);
  EXPECT_EQ(options.mapping.closures.candidates.max_matches, 7);
  int changed = 0;
  const auto after = OptionValues(options);
  for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != after[i] ? 1 : 0;
  EXPECT_EQ(changed, 2);
}

TEST(OptionTable, ValuesReadBackToTheLastBit) {
  Options options;
  const double value = 0.1 + 0.2;
  options.mapping.closures.matcher.min_score = value;
  SetOption("matcher.min_score=" + TextOf(options, "matcher.min_score"), options);
  EXPECT_EQ(options.mapping.closures.matcher.min_score, value);
}

TEST(OptionTable, MistakesAreOneClearLine) {
  EXPECT_EQ(MessageOf("matcher.min_scor=0.5"),
            "--set: unknown option `matcher.min_scor` (did you mean `matcher.min_score`?)");
  EXPECT_EQ(MessageOf("min_score=0.5"),
            "--set: unknown option `min_score` (did you mean `matcher.min_score`?)");
  EXPECT_EQ(MessageOf("nonsense=1"), "--set: unknown option `nonsense`");
  EXPECT_EQ(MessageOf("matcher.min_score"), "--set `matcher.min_score`: expected key=value");
  EXPECT_EQ(MessageOf("matcher.min_score=1.5"),
            "--set: matcher.min_score must be 0 to 1, not `1.5`");
  EXPECT_EQ(MessageOf("validator.votes_needed=2.5"),
            "--set: validator.votes_needed must be a whole number, not `2.5`");
  for (const char* bad : {"", "x", "0.5x", " 0.5", "nan", "inf", "1e999", "+-1", "-", "0,5"}) {
    EXPECT_EQ(MessageOf("matcher.min_score=" + std::string(bad)),
              "--set: matcher.min_score must be a number, not `" + std::string(bad) + "`");
  }
  EXPECT_NE(MessageOf("candidates.max_matches=99999999999999999999"), "");
  EXPECT_NE(MessageOf("candidates.max_matches=-1"), "");
  const std::string long_line = MessageOf("a\nb=" + std::string(100000, 'x'));
  EXPECT_EQ(long_line, "--set: unknown option `a?b`");
}

TEST(OptionTable, AFailedSettingChangesNothing) {
  Options options;
  EXPECT_THROW(SetOption("matcher.min_score=7", options), InputError);
  EXPECT_EQ(options.mapping.closures.matcher.min_score,
            Options{}.mapping.closures.matcher.min_score);
}

TEST(OptionTable, ContradictionsAreNamed) {
  Options options;
  options.mapping.nodes.min_edge_length_m = 10.0;
  try {
    CheckOptions(options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "nodes.min_edge_length_m (10) must not be above nodes.max_edge_length_m (9)");
  }
}

TEST(OptionTable, AFileOfFloorsIsForLabelsOnly) {
  Options options;
  options.mapping.floors.file = "floors.csv";
  EXPECT_NO_THROW(CheckOptions(options));
  options.mapping.floors.source = FloorSource::kLabels;
  EXPECT_NO_THROW(CheckOptions(options));
  options.mapping.floors.source = FloorSource::kPressure;
  EXPECT_THROW(CheckOptions(options), InputError);
}

TEST(OptionTable, ValuesHaveTheTypesOfTheirFields) {
  const auto values = OptionValues(Options{});
  const std::map<std::string, OptionValue> by_key(values.begin(), values.end());
  EXPECT_EQ(by_key.at("matcher.min_score"), OptionValue(0.425));
  EXPECT_EQ(by_key.at("validator.votes_needed"), OptionValue(std::int64_t{6}));
  EXPECT_EQ(by_key.at("motion.source"), OptionValue(std::string("auto")));
}

TEST(OptionTable, ThreadsAreNotPartOfTheResult) {
  for (const auto& [key, value] : OptionValues(Options{})) EXPECT_NE(key, "threads");
}

}  // namespace
}  // namespace masked_mapper
