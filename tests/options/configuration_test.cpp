// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/option_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "house/source_tree.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::string MessageOf(const std::string& text) {
  Options options;
  try {
    ReadConfigurationText("my.yaml", text, options);
  } catch (const InputError& error) {
    EXPECT_EQ(OptionValues(options), OptionValues(Options{})) << "half-read: " << text;
    return error.what();
  }
  return "";
}

TEST(Configuration, NestedAndDottedKeysAreTheSame) {
  Options nested;
  ReadConfigurationText(
      "n", "motion:\n  source: odometry\n  odometry:\n    sigma_position_per_step: 0.5\n", nested);
  Options dotted;
  ReadConfigurationText(
      "d", "motion.source: odometry\nmotion.odometry: {sigma_position_per_step: 0.5}\n", dotted);
  EXPECT_EQ(nested.mapping.motion.source, MotionSource::kOdometry);
  EXPECT_EQ(nested.mapping.motion.odometry.sigma_position_per_step, 0.5);
  EXPECT_EQ(OptionValues(nested), OptionValues(dotted));
}

TEST(Configuration, EmptyFilesAndSectionsChangeNothing) {
  for (const char* text : {"", "\n", "# only a comment\n", "---\n", "matcher:\n", "{}"}) {
    EXPECT_EQ(MessageOf(text), "") << text;
  }
}

TEST(Configuration, MistakesNameFileLineAndKey) {
  EXPECT_EQ(MessageOf("nodes:\nmatcher:\n  min_scor: 0.5\n"),
            "my.yaml:3: unknown option `matcher.min_scor` (did you mean `matcher.min_score`?)");
  EXPECT_EQ(MessageOf("candidates:\n  max_matches: 2\nmatcher:\n  min_score: 2\n"),
            "my.yaml:4: matcher.min_score must be 0 to 1, not `2`");
  EXPECT_EQ(MessageOf("matcher:\n  min_score: high\n"),
            "my.yaml:2: matcher.min_score must be a number, not `high`");
  EXPECT_EQ(MessageOf("matcher:\n  min_score: [0.5]\n"),
            "my.yaml:2: matcher.min_score must be one value, or a section of options");
  EXPECT_EQ(MessageOf("matcher: 3\n"), "my.yaml:1: unknown option `matcher`");
  EXPECT_EQ(MessageOf("candidates:\n  max_matches: 2\n  max_matches: 3\n"),
            "my.yaml:3: candidates.max_matches is given twice");
  EXPECT_EQ(MessageOf("just words"), "my.yaml:1: expected sections of `key: value` lines");
  EXPECT_EQ(MessageOf("threads: 1\n---\nthreads: 2\n"),
            "my.yaml: holds more than one YAML document");
  EXPECT_EQ(
      MessageOf("threads: 1\nmatcher: {min_score: 0.5\n").rfind("my.yaml:3: not valid YAML", 0),
      0U);
}

TEST(Configuration, EnemiesEndInAMessage) {
  const std::string deep(100000, '[');
  for (const std::string& text :
       {deep, std::string(100000, '{'), std::string("a: &a\n  b: *a\n"),
        std::string("? [x]\n: y\n"), std::string("\0\1\2", 3), std::string("a: *nowhere\n"),
        std::string("<<: {threads: 1}\n"), std::string("matcher: &m {matcher: *m}\n"),
        std::string("\xff\xfe\x00x", 4)}) {
    EXPECT_NE(MessageOf(text), "") << text.substr(0, 20);
  }
}

TEST(Configuration, UnreadableFilesAreTheUsersFault) {
  Options options;
  EXPECT_THROW(ReadConfiguration("/nowhere/at/all.yaml", options), InputError);
  EXPECT_THROW(ReadConfiguration(::testing::TempDir(), options), InputError);
  const std::string large = ::testing::TempDir() + "large.yaml";
  std::ofstream(large) << std::string(2 << 20, '#');
  EXPECT_THROW(ReadConfiguration(large, options), InputError);
  std::filesystem::remove(large);
}

TEST(Configuration, WhatIsWrittenIsReadBack) {
  Options options;
  SetOption("matcher.min_score=0.123", options);
  SetOption("masks.openings.min_turn_deg=33", options);
  SetOption("motion.source=odometry", options);
  Options read;
  ReadConfigurationText("written", ConfigurationText(options), read);
  EXPECT_EQ(OptionValues(read), OptionValues(options));
}

TEST(Configuration, EveryShippedFileIsRead) {
  const auto files = house::FilesUnder("config", {".yaml", ".yml"});
  ASSERT_FALSE(files.empty());
  for (const auto& file : files) {
    Options options;
    EXPECT_NO_THROW(ReadConfiguration((house::Root() / file).string(), options)) << file;
    EXPECT_NO_THROW(CheckOptions(options)) << file;
  }
}

TEST(Configuration, DefaultFileIsTheTable) {
  const std::string text = house::ReadAll(house::Root() / "config/default.yaml");
  // The comment at its head is for people; from the first option on it is generated.
  const std::size_t first = text.find("\nthreads:");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.substr(first + 1), ConfigurationText(Options{}))
      << "regenerate: masked_mapper map --help-options";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

}  // namespace
}  // namespace masked_mapper
