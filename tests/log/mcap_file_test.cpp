// SPDX-License-Identifier: BSD-3-Clause
#include "log/mcap_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "log/mcap_bytes.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

struct McapContent {
  std::vector<std::pair<double, std::string>> messages;
  std::map<std::uint32_t, BagConnection> connections;
  bool truncated = false;
  std::uint64_t damaged = 0;
  std::string first_damage;
};

McapContent ReadMcap(const std::string& bytes) {
  const TemporaryFile file(".mcap", bytes);
  const std::unique_ptr<RosBag> mcap = OpenMcap(file.path(), "x.mcap");
  McapContent content;
  for (int round = 0; round < 2; ++round) {
    content = {};
    while (const std::optional<BagMessage> message = mcap->Next()) {
      EXPECT_EQ(mcap->Connections().count(message->connection), 1U);
      content.messages.emplace_back(
          message->time, std::string(reinterpret_cast<const char*>(message->data), message->size));
    }
    EXPECT_EQ(mcap->Progress(), 1.0);
    content.connections = mcap->Connections();
    content.truncated = mcap->Truncated();
    content.damaged = mcap->Damaged();
    content.first_damage = mcap->FirstDamage();
    mcap->Rewind();
  }
  return content;
}

std::string Described() {
  return McapSchemaBytes(1, "sensor_msgs/msg/LaserScan") + McapChannelBytes(7, 1, "/scan");
}

/// Messages at 100 s and so on, one per second, with the second as data.
std::string Messages(int first, int count) {
  std::string records;
  for (int second = first; second < first + count; ++second) {
    records += McapMessageBytes(7, second, std::to_string(second));
  }
  return records;
}

void ExpectSeconds(const McapContent& content, int first, int count) {
  ASSERT_EQ(content.messages.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(content.messages[static_cast<std::size_t>(i)].first, first + i);
    EXPECT_EQ(content.messages[static_cast<std::size_t>(i)].second, std::to_string(first + i));
  }
}

TEST(McapFileTest, ReadsBareMessagesAndChunksOfBothKinds) {
  const std::string bare = McapBytes(Described() + Messages(100, 4));
  const std::string plain = Described() + Messages(100, 2);
  const std::string chunked = McapBytes(McapChunkBytes(100, plain, plain.size(), CrcOf(plain), "") +
                                        McapZstdChunk(102, Messages(102, 2)));
  for (const std::string& bytes : {bare, chunked}) {
    const McapContent content = ReadMcap(bytes);
    ExpectSeconds(content, 100, 4);
    EXPECT_FALSE(content.truncated);
    EXPECT_EQ(content.damaged, 0U) << content.first_damage;
    ASSERT_EQ(content.connections.size(), 1U);
    EXPECT_EQ(content.connections.at(7).topic, "/scan");
    EXPECT_EQ(content.connections.at(7).type, "sensor_msgs/msg/LaserScan");
  }
}

TEST(McapFileTest, TheOrderIsThatOfTimeWhereverAChunkStands) {
  std::string swapped = McapMessageBytes(7, 103, "103") + McapMessageBytes(7, 102, "102");
  const McapContent content =
      ReadMcap(McapBytes(McapZstdChunk(104, Messages(104, 2)) + McapZstdChunk(102, swapped) +
                         Messages(106, 1) + McapZstdChunk(100, Described() + Messages(100, 2))));
  ExpectSeconds(content, 100, 7);
  // Two chunks that interleave.
  std::string even = Described();
  std::string odd;
  for (int second = 100; second < 110; ++second) {
    (second % 2 == 0 ? even : odd) += McapMessageBytes(7, second, std::to_string(second));
  }
  ExpectSeconds(ReadMcap(McapBytes(McapZstdChunk(101, odd) + McapZstdChunk(100, even))), 100, 10);
}

TEST(McapFileTest, WhatIsUnknownIsSkipped) {
  const std::string unknown = McapRecordBytes(0x7f, "whatever");
  std::string padded = McapChannelBytes(7, 1, "/scan") + "more";
  padded[1] = static_cast<char>(padded[1] + 4);
  const McapContent content = ReadMcap(
      McapBytes(unknown + McapSchemaBytes(1, "sensor_msgs/msg/LaserScan") + padded +
                McapZstdChunk(100, unknown + Messages(100, 2) + unknown) + Messages(102, 1)) +
      "behind the end");
  ExpectSeconds(content, 100, 3);
  EXPECT_EQ(content.damaged, 0U) << content.first_damage;
}

TEST(McapFileTest, ACutFileGivesWhatItHas) {
  const std::string bytes = McapBytes(McapZstdChunk(100, Described() + Messages(100, 3)) +
                                      Messages(103, 3) + McapZstdChunk(106, Messages(106, 3)));
  std::size_t last_count = 0;
  for (std::size_t length = kMcapMagicBytes.size(); length < bytes.size(); length += 3) {
    const McapContent content = ReadMcap(bytes.substr(0, length));
    EXPECT_TRUE(content.truncated || bytes.size() - length <= kMcapMagicBytes.size()) << length;
    EXPECT_EQ(content.damaged, 0U) << content.first_damage;
    EXPECT_GE(content.messages.size(), last_count);
    last_count = content.messages.size();
  }
  EXPECT_EQ(last_count, 9U);
}

TEST(McapFileTest, ABadChunkIsCountedAndSkipped) {
  const std::string records = Messages(102, 2);
  const std::string good = McapZstdChunk(100, Described() + Messages(100, 2));
  struct Case {
    std::string chunk;
    const char* words;
  };
  const std::string packed = ZstdPacked(records);
  for (const Case& bad : std::vector<Case>{
           {McapChunkBytes(102, packed, records.size(), CrcOf(records) ^ 1U, "zstd"), "checksum"},
           {McapChunkBytes(102, packed, std::uint64_t{1} << 40U, 0, "zstd"),
            "claims to unpack to 1099511627776 bytes"},
           {McapChunkBytes(102, records, records.size() + 1, 0, ""), "claims to unpack"},
           {McapChunkBytes(102, "no frame", 100, 0, "lz4"), "cannot be unpacked"},
           {McapChunkBytes(102, packed, records.size() - 1, 0, "zstd"), "cut"},
           {McapChunkBytes(102, packed, records.size() + 1, 0, "zstd"), "has not the size"},
           {McapChunkBytes(102, packed, 100, 0, "brotli"), "`brotli`, which is not known"}}) {
    const McapContent content = ReadMcap(McapBytes(good + bad.chunk + Messages(104, 1)));
    EXPECT_GE(content.messages.size(), 3U);
    EXPECT_EQ(content.messages.back().second, "104");
    EXPECT_EQ(content.damaged, 1U) << bad.words;
    EXPECT_NE(content.first_damage.find(bad.words), std::string::npos) << content.first_damage;
  }
}

TEST(McapFileTest, TheReadingGoesOnBehindALengthThatIsNone) {
  const std::string first = McapZstdChunk(100, Described() + Messages(100, 2));
  const std::string last = McapZstdChunk(104, Messages(104, 2));
  std::string middle = McapZstdChunk(102, Messages(102, 2));
  middle[8] = '\x7f';
  const std::string data = kMcapMagicBytes + McapHeaderBytes() + first + middle + last;
  const std::uint64_t last_chunk = data.size() - last.size();
  const std::string end = McapRecordBytes(15, Raw(std::uint32_t{0}));
  const std::string index =
      McapRecordBytes(8, std::string(16, '\0') + Raw(last_chunk) + std::string(64, '\0'));
  const std::string footer = McapRecordBytes(2, Raw(std::uint64_t{data.size() + end.size()}) +
                                                    Raw(std::uint64_t{0}) + Raw(std::uint32_t{0}));
  const McapContent content = ReadMcap(data + end + index + footer + kMcapMagicBytes);
  ASSERT_EQ(content.messages.size(), 4U);
  EXPECT_EQ(content.messages.back().second, "105");
  EXPECT_EQ(content.damaged, 1U);
}

TEST(McapFileTest, ChecksumsOfDataAndSummaryAreChecked) {
  const std::string data = kMcapMagicBytes + McapHeaderBytes() + Described() + Messages(100, 2);
  for (const bool spoilt : {false, true}) {
    const std::string end = McapRecordBytes(15, Raw(CrcOf(data) ^ (spoilt ? 1U : 0U)));
    const std::string summary = Described();
    std::string footer = McapRecordBytes(2, Raw(std::uint64_t{data.size() + end.size()}) +
                                                Raw(std::uint64_t{0}) + Raw(std::uint32_t{0}));
    footer.resize(footer.size() - 4);
    const std::uint32_t crc = CrcOf(summary + footer) ^ (spoilt ? 1U : 0U);
    const McapContent content =
        ReadMcap(data + end + summary + footer + Raw(crc) + kMcapMagicBytes);
    ExpectSeconds(content, 100, 2);
    EXPECT_EQ(content.damaged, spoilt ? 2U : 0U) << content.first_damage;
  }
}

TEST(McapFileTest, EncodingsAreToldApart) {
  std::string channel = McapRecordBytes(
      4, Raw(std::uint16_t{2}) + Raw(std::uint16_t{2}) + WithLength("/old") + WithLength("ros1") +
             WithLength(WithLength("md5sum") + WithLength("90c7")));
  const McapContent content = ReadMcap(
      McapBytes(Described() + McapSchemaBytes(2, "sensor_msgs/LaserScan", "ros1msg") + channel +
                McapChannelBytes(3, 1, "/text", "json") + McapChannelBytes(4, 0, "/bare", "")));
  EXPECT_EQ(content.connections.at(2).type, "sensor_msgs/LaserScan");
  EXPECT_EQ(content.connections.at(2).md5sum, "90c7");
  EXPECT_EQ(content.connections.at(3).type, "sensor_msgs/msg/LaserScan as json");
  EXPECT_EQ(content.connections.at(4).type, "no schema as something unsaid");
}

TEST(McapFileTest, AMessageOfNoChannelIsCounted) {
  const McapContent content =
      ReadMcap(McapBytes(Described() + McapMessageBytes(9, 99, "x") + Messages(100, 1)));
  ExpectSeconds(content, 100, 1);
  EXPECT_EQ(content.damaged, 1U);
  EXPECT_NE(content.first_damage.find("channel 9"), std::string::npos);
}

TEST(McapFileTest, RefusesOtherVersionsAndWhatIsNoMcap) {
  const auto refusal = [](const std::string& bytes) -> std::string {
    try {
      ReadMcap(bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("\x89MCAP1\r\n"), "x.mcap: is MCAP of version `1`; version 0 is read");
  EXPECT_EQ(refusal("something"), "x.mcap: is not an MCAP file");
  EXPECT_EQ(refusal(kMcapMagicBytes), "");
  EXPECT_THROW(OpenMcap("/no/such.mcap", "x"), InputError);
}

// Whatever the bytes are, the reader ends; sanitizers watch over this test.
TEST(McapFileTest, SurvivesGarbledBytes) {
  std::mt19937 random(3);
  const std::string good = McapBytes(McapZstdChunk(100, Described() + Messages(100, 5)) +
                                     Messages(105, 5) + McapZstdChunk(110, Messages(110, 5)));
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 5; ++k) {
      bytes[kMcapMagicBytes.size() + random() % (bytes.size() - kMcapMagicBytes.size())] =
          static_cast<char>(random());
    }
    ReadMcap(bytes);
  }
}

}  // namespace
}  // namespace masked_mapper
