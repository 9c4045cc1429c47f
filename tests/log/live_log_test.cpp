// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/live_log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "log/temporary_file.hpp"

namespace masked_mapper {
namespace {

std::string Text(int scans) {
  std::string text = "# a log\n";
  for (int i = 0; i < scans; ++i) {
    const std::string stamp = std::to_string(100 + i) + ".25";
    const std::string pose = std::to_string(0.1 * i) + " 0 0 ";
    text += "ODOM " + pose + "0 0 0 " + stamp + " nohost " + stamp + "\n";
    text += "FLASER 5 1.5 2.5 81.83 2.5 1.5 " + pose + pose + stamp + " nohost " + stamp + "\n";
  }
  return text;
}

std::vector<double> StampsOf(LiveLog* log) {
  std::vector<double> stamps;
  while (const std::optional<Observation> observation = log->Next()) {
    stamps.push_back(Stamp(*observation));
  }
  return stamps;
}

// However the bytes come, the observations are those of the file.
TEST(LiveLog, GivesWhatTheFileGives) {
  const std::string text = Text(130);
  const TemporaryFile file("live.log", text);
  std::vector<double> of_the_file;
  const auto reader = OpenLog(file.path(), LogOptions());
  while (const auto observation = reader->Next()) of_the_file.push_back(Stamp(*observation));
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{5000}, text.size()}) {
    LiveLog log{LogOptions()};
    std::vector<double> stamps;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      log.Add(std::string_view(text).substr(at, piece));
      for (const double stamp : StampsOf(&log)) stamps.push_back(stamp);
    }
    log.Finish();
    for (const double stamp : StampsOf(&log)) stamps.push_back(stamp);
    EXPECT_EQ(stamps, of_the_file) << piece;
    EXPECT_EQ(log.Statistics().scans, 130U);
    EXPECT_FALSE(log.Statistics().truncated);
  }
}

TEST(LiveLog, HalfALineAtTheEndIsLeftOut) {
  std::string text = Text(120);
  text.resize(text.size() - 60);
  LiveLog log{LogOptions()};
  log.Add(text);
  log.Finish();
  StampsOf(&log);
  EXPECT_TRUE(log.Statistics().truncated);
  EXPECT_EQ(log.Statistics().scans, 119U);
}

TEST(LiveLog, NothingComesOfNothing) {
  LiveLog log{LogOptions()};
  EXPECT_FALSE(log.Next());
  log.Finish();
  EXPECT_FALSE(log.Next());
  EXPECT_EQ(log.Statistics().scans, 0U);
}

TEST(LiveLog, TellsTextFromWhatIsPacked) {
  EXPECT_TRUE(BeginsAsText("FLASER 3 1 2 3\r\n"));
  EXPECT_FALSE(BeginsAsText(std::string("\x1f\x8b\x08\x00", 4)));
}

}  // namespace
}  // namespace masked_mapper
