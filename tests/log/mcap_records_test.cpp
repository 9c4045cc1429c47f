// SPDX-License-Identifier: BSD-3-Clause
#include "log/mcap_records.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "log/open_bag.hpp"
#include "log/temporary_file.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// One record as the suite's expectations spell it: numbers as text, bytes as lists of them.
class SpelledRecord {
 public:
  explicit SpelledRecord(const McapRecord& record) : fields_(record) { Spell(record.op); }

  Json json() const { return {{"type", type_}, {"fields", list_}}; }
  bool good() const { return fields_.good(); }

 private:
  void Number(const char* name, std::size_t bytes) {
    Add(name, std::to_string(fields_.Number(bytes)));
  }
  void Text(const char* name) { Add(name, fields_.String()); }
  void Data(const char* name, std::string_view bytes) {
    Json list = Json::array();
    for (const char byte : bytes) list.push_back(std::to_string(static_cast<unsigned char>(byte)));
    Add(name, list);
  }
  void Rest(const char* name) {
    Data(name, {reinterpret_cast<const char*>(fields_.here()), fields_.left()});
  }
  void Map(const char* name) {
    Json map = Json::object();
    for (const auto& [key, value] : fields_.Map()) map[key] = value;
    Add(name, map);
  }
  /// From numbers of two bytes to numbers of eight.
  void NumberMap(const char* name) {
    const std::string_view bytes = fields_.Bytes();
    McapFields inner(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    Json map = Json::object();
    while (inner.left() > 0 && inner.good()) {
      const std::uint16_t key = inner.U16();
      map[std::to_string(key)] = std::to_string(inner.U64());
    }
    Add(name, map);
  }
  void Add(const char* name, Json value) { list_.push_back({name, std::move(value)}); }

  void Spell(McapOp op) {
    switch (op) {
      case McapOp::kHeader:
        type_ = "Header";
        Text("profile"), Text("library");
        break;
      case McapOp::kFooter:
        type_ = "Footer";
        Number("summary_start", 8), Number("summary_offset_start", 8), Number("summary_crc", 4);
        break;
      case McapOp::kSchema:
        type_ = "Schema";
        Number("id", 2), Text("name"), Text("encoding"), Data("data", fields_.Bytes());
        break;
      case McapOp::kChannel:
        type_ = "Channel";
        Number("id", 2), Number("schema_id", 2), Text("topic"), Text("message_encoding");
        Map("metadata");
        break;
      case McapOp::kMessage:
        type_ = "Message";
        Number("channel_id", 2), Number("sequence", 4), Number("log_time", 8);
        Number("publish_time", 8), Rest("data");
        break;
      case McapOp::kAttachment:
        type_ = "Attachment";
        Number("log_time", 8), Number("create_time", 8), Text("name"), Text("media_type");
        Data("data", fields_.Bytes(8));
        break;
      case McapOp::kAttachmentIndex:
        type_ = "AttachmentIndex";
        Number("offset", 8), Number("length", 8), Number("log_time", 8), Number("create_time", 8);
        Number("data_size", 8), Text("name"), Text("media_type");
        break;
      case McapOp::kChunkIndex:
        type_ = "ChunkIndex";
        Number("message_start_time", 8), Number("message_end_time", 8);
        Number("chunk_start_offset", 8), Number("chunk_length", 8);
        NumberMap("message_index_offsets"), Number("message_index_length", 8);
        Text("compression"), Number("compressed_size", 8), Number("uncompressed_size", 8);
        break;
      case McapOp::kStatistics:
        type_ = "Statistics";
        Number("message_count", 8), Number("schema_count", 2), Number("channel_count", 4);
        Number("attachment_count", 4), Number("metadata_count", 4), Number("chunk_count", 4);
        Number("message_start_time", 8), Number("message_end_time", 8);
        NumberMap("channel_message_counts");
        break;
      case McapOp::kMetadata:
        type_ = "Metadata";
        Text("name"), Map("metadata");
        break;
      case McapOp::kMetadataIndex:
        type_ = "MetadataIndex";
        Number("offset", 8), Number("length", 8), Text("name");
        break;
      case McapOp::kSummaryOffset:
        type_ = "SummaryOffset";
        Number("group_opcode", 1), Number("group_start", 8), Number("group_length", 8);
        break;
      case McapOp::kDataEnd:
        type_ = "DataEnd";
        Number("data_section_crc", 4);
        break;
      case McapOp::kChunk:
      case McapOp::kMessageIndex:
        break;
    }
    std::sort(list_.begin(), list_.end());
  }

  McapFields fields_;
  std::string type_;
  std::vector<Json> list_;
};

/// Records of a file with those of its chunks in their places; indexes of messages are left out, as
/// the suite does.
void Spell(const unsigned char* data, std::size_t size, Json* list) {
  McapRecords records(data, size);
  McapUnpacker unpacker;
  while (const std::optional<McapRecord> record = records.Next()) {
    if (record->op == McapOp::kMessageIndex || record->op > McapOp::kDataEnd) continue;
    if (record->op != McapOp::kChunk) {
      const SpelledRecord spelled(*record);
      EXPECT_TRUE(spelled.good());
      list->push_back(spelled.json());
      continue;
    }
    const std::optional<McapChunk> chunk = ParseMcapChunk(record->data, record->size);
    ASSERT_TRUE(chunk);
    const unsigned char* begin = record->data + chunk->fields_size;
    Bytes packed(begin, begin + chunk->packed_size);
    Bytes inner;
    EXPECT_EQ(unpacker.Unpack(*chunk, false, &packed, &inner), "");
    Spell(inner.data(), inner.size(), list);
  }
}

std::string ReadWhole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Messages in the order that a bag has: of time, and in the file's where that is the same.
std::vector<std::pair<std::uint64_t, std::string>> MessagesOf(const Json& records) {
  std::vector<std::pair<std::uint64_t, std::string>> messages;
  for (const Json& record : records) {
    if (record["type"] != "Message") continue;
    std::uint64_t time = 0;
    std::string data;
    for (const Json& field : record["fields"]) {
      if (field[0] == "log_time") time = std::stoull(field[1].get<std::string>());
      if (field[0] != "data") continue;
      for (const Json& byte : field[1]) {
        data.push_back(static_cast<char>(std::stoi(byte.get<std::string>())));
      }
    }
    messages.emplace_back(time, data);
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return messages;
}

TEST(McapRecordsTest, EveryRecordOfTheOfficialSuiteIsReadAsExpected) {
  const std::string suite = std::string(MASKED_MAPPER_REAL_LOGS) + "/bags/mcap/conformance.tar.gz";
  if (!fs::exists(suite)) GTEST_SKIP() << suite << " is not here";
  const TemporaryFile name(".suite");
  const fs::path folder = name.path() + ".folder";
  fs::create_directory(folder);
  const std::string unpack = "tar xzf " + suite + " -C " + folder.string();
  ASSERT_EQ(std::system(unpack.c_str()), 0);
  std::size_t files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".mcap") continue;
    ++files;
    const Json expected = Json::parse(ReadWhole(fs::path(entry).replace_extension(".json")));
    const std::string bytes = ReadWhole(entry.path());
    ASSERT_GT(bytes.size(), 2 * kMcapMagic.size());
    Json records = Json::array();
    Spell(reinterpret_cast<const unsigned char*>(bytes.data()) + kMcapMagic.size(),
          bytes.size() - 2 * kMcapMagic.size(), &records);
    EXPECT_EQ(records, expected["records"]) << entry.path();

    std::vector<std::pair<std::uint64_t, std::string>> messages;
    const std::unique_ptr<RosBag> bag = OpenBag(entry.path().string());
    while (const std::optional<BagMessage> message = bag->Next()) {
      messages.emplace_back(
          static_cast<std::uint64_t>(message->time * 1e9 + 0.5),
          std::string(reinterpret_cast<const char*>(message->data), message->size));
    }
    EXPECT_EQ(messages, MessagesOf(expected["records"])) << entry.path();
    EXPECT_FALSE(bag->Truncated()) << entry.path();
    EXPECT_EQ(bag->Damaged(), 0U) << entry.path() << ": " << bag->FirstDamage();
  }
  EXPECT_EQ(files, 416U);
  fs::remove_all(folder);
}

TEST(McapRecordsTest, FieldsThatDoNotFitAreNone) {
  const std::string bytes(
      "\x05\x00\x00\x00"
      "abc",
      7);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  McapFields too_long(data, bytes.size());
  EXPECT_EQ(too_long.Bytes(), "");
  EXPECT_FALSE(too_long.good());
  EXPECT_EQ(too_long.U16(), 0U);
  McapFields number(data, 3);
  EXPECT_EQ(number.U32(), 0U);
  EXPECT_FALSE(number.good());
  McapRecords records(data, bytes.size());
  EXPECT_FALSE(records.Next());
  EXPECT_EQ(records.left(), bytes.size());
}

}  // namespace
}  // namespace masked_mapper
