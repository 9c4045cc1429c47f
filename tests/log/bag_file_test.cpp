// SPDX-License-Identifier: BSD-3-Clause
#include "log/bag_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "log/bag_bytes.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::size_t CountMessages(RosBag* bag) {
  std::size_t count = 0;
  while (const std::optional<BagMessage> message = bag->Next()) {
    EXPECT_GT(bag->Connections().count(message->connection), 0U);
    ++count;
  }
  EXPECT_EQ(bag->Progress(), 1.0);
  return count;
}

TEST(BagFileTest, ReadsMessagesInOrderTwice) {
  for (const bool indexed : {true, false}) {
    const TemporaryFile file(".bag", ScanBag(indexed));
    const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
    EXPECT_EQ(bag->IsIndexed(), indexed);
    EXPECT_EQ(bag->Connections().size(), indexed ? 1U : 0U);
    for (int round = 0; round < 2; ++round) {
      for (std::uint32_t i = 0; i < 12; ++i) {
        const std::optional<BagMessage> message = bag->Next();
        ASSERT_TRUE(message);
        EXPECT_EQ(message->time, 100.5 + i);
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(message->data), message->size),
                  LaserScanBytes(100 + i, 5));
      }
      EXPECT_FALSE(bag->Next());
      EXPECT_EQ(bag->Truncated(), !indexed);
      EXPECT_EQ(bag->Damaged(), 0U);
      bag->Rewind();
    }
    EXPECT_EQ(bag->Connections().at(7).type, "sensor_msgs/LaserScan");
  }
}

TEST(BagFileTest, ACutBagGivesWhatItHas) {
  const std::string bytes = ScanBag(true);
  std::size_t last_count = 0;
  for (std::size_t length = BagMagic().size(); length <= bytes.size(); length += 7) {
    const TemporaryFile file(".bag", bytes.substr(0, length));
    const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
    const std::size_t count = CountMessages(bag.get());
    EXPECT_GE(count, last_count);
    EXPECT_EQ(bag->Damaged(), 0U) << length;
    last_count = count;
  }
  EXPECT_EQ(last_count, 12U);
}

TEST(BagFileTest, ReadsWhatADyingRecorderLeft) {
  // No size in the chunk's header yet, and its records behind it.
  const std::string connection =
      ConnectionRecord(1, "/scan", "sensor_msgs/LaserScan", kLaserScanMd5);
  const TemporaryFile file(".bag", BagMagic() + BagHeaderRecord(0, 0, 0) + ChunkRecord("") +
                                       connection + MessageRecord(1, 5, "abc") +
                                       MessageRecord(1, 6, "def").substr(0, 30));
  const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
  EXPECT_EQ(CountMessages(bag.get()), 1U);
  EXPECT_TRUE(bag->Truncated());
}

TEST(BagFileTest, GoesOnAtTheNextChunkBehindADamagedRecord) {
  std::string bytes = ScanBag(true);
  const std::size_t second_chunk = bytes.find("compression", bytes.find("compression") + 10) - 8;
  bytes[second_chunk + 3] = '\x7f';  // an absurd length
  const TemporaryFile file(".bag", bytes);
  const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
  EXPECT_GE(CountMessages(bag.get()), 8U);
  EXPECT_TRUE(bag->Truncated());
}

TEST(BagFileTest, IndexRecordsOfTheFirstRecordersStateAWrongLength) {
  std::string bytes = ScanBag(false);
  const std::string index =
      BagRecord({{"op", Op(4)}, {"ver", Raw(std::uint32_t{1})}, {"count", Raw(std::uint32_t{3})}},
                std::string(36, 'x'));
  const std::string first = ScanBag(false, 0);
  std::string wrong = index;
  wrong.replace(wrong.size() - 40, 4, Raw(std::uint32_t{60}));
  // Behind the first chunk.
  const std::size_t second_chunk = bytes.find("compression", bytes.find("compression") + 10) -
                                   (ChunkRecord("").find("compression"));
  bytes.insert(second_chunk, wrong);
  const TemporaryFile file(".bag", bytes);
  const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
  EXPECT_EQ(CountMessages(bag.get()), 12U);
  EXPECT_EQ(bag->Damaged(), 0U);
}

TEST(BagFileTest, DamagedCompressionIsCountedNotFatal) {
  for (const char* compression : {"bz2", "lz4", "unheard_of"}) {
    std::string bytes = ScanBag(true);
    for (std::size_t at = bytes.find("=none"); at != std::string::npos; at = bytes.find("=none")) {
      bytes.replace(at - 15, 20,
                    WithLength(std::string("compression=") + compression).substr(0, 20));
    }
    if (std::string(compression).size() != 3) continue;
    const TemporaryFile file(".bag", bytes);
    const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
    CountMessages(bag.get());
  }
}

TEST(BagFileTest, RefusesOtherVersionsAndWhatIsNoBag) {
  const auto message = [](const std::string& bytes) -> std::string {
    const TemporaryFile file(".bag", bytes);
    try {
      OpenRos1Bag(file.path(), file.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("#ROSBAG V1.2\nwhatever").find("version 1.2"), std::string::npos);
  EXPECT_NE(message("#ROSBAG V").find("obsolete"), std::string::npos);
  EXPECT_NE(message("not a bag").find("is not a ROS bag"), std::string::npos);
  EXPECT_NE(
      message(BagMagic() + BagRecord({{"op", Op(3)}, {"encryptor", "AES"}}, "")).find("encrypted"),
      std::string::npos);
  EXPECT_EQ(message(BagMagic()), "");
  EXPECT_THROW(OpenRos1Bag("/no/such.bag", "x.bag"), InputError);
}

// Whatever the bytes are, the reader ends; sanitizers watch over this test.
TEST(BagFileTest, SurvivesGarbledBytes) {
  std::mt19937 random(3);
  const std::string good = ScanBag(true);
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 5; ++k) {
      bytes[BagMagic().size() + random() % (bytes.size() - BagMagic().size())] =
          static_cast<char>(random());
    }
    const TemporaryFile file(".bag", bytes);
    try {
      const std::unique_ptr<RosBag> bag = OpenRos1Bag(file.path(), file.path());
      std::size_t count = 0;
      while (bag->Next()) ++count;
      EXPECT_LE(count, 100U);
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace masked_mapper
