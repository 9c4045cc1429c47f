// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_source.hpp"

#include <gtest/gtest.h>

#include "log/bag_drive.hpp"

namespace masked_mapper::bag_drive {
namespace {

TEST(RecordingsTest, BagsThatGoOnFromEachOtherAreOne) {
  const Drive drive;
  const TemporaryFile first(".bag", Drive::Bag(drive.Part(0, 150)));
  const TemporaryFile second(".bag", Drive::Bag(drive.Part(150, 300)));
  const TemporaryFile third(".bag", Drive::Bag(drive.Part(300, kScans)));
  const TemporaryFile text(".log", "# a text log\n");
  const auto recordings = RecordingsOf({third.path(), text.path(), first.path(), second.path()});
  ASSERT_EQ(recordings.size(), 2U);
  EXPECT_EQ(recordings[0], (std::vector<std::string>{first.path(), second.path(), third.path()}));
  EXPECT_EQ(recordings[1], std::vector<std::string>{text.path()});
  LogSource source(recordings[0], {});
  ExpectTheDrive(ReadSource(source));
  EXPECT_EQ(RecordingsOf({first.path(), third.path()}).size(), 2U) << "a gap of 15 s";
  EXPECT_EQ(RecordingsOf({first.path(), first.path()}).size(), 2U) << "the same drive twice";
}

}  // namespace
}  // namespace masked_mapper::bag_drive
