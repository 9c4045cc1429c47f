// SPDX-License-Identifier: BSD-3-Clause
#include "ros1_bag_writer.hpp"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "output_bytes.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kChunk = std::size_t{768} << 10U;  // as rosbag closes them
constexpr std::size_t kBagHeader = 4096;

template <typename T>
std::string Number(T value) {
  std::string bytes;
  AppendNumber(value, &bytes);
  return bytes;
}

using FieldList = std::initializer_list<std::pair<const char*, std::string>>;

std::string Fields(const FieldList& fields) {
  std::string bytes;
  for (const auto& [name, value] : fields) AppendString(name + ("=" + value), &bytes);
  return bytes;
}

std::string Record(char op, const FieldList& fields, std::string_view data) {
  std::string header = Fields(fields);
  AppendString(std::string("op=") + op, &header);
  std::string record;
  AppendString(header, &record);
  AppendString(data, &record);
  return record;
}

std::string RosTime(std::uint64_t time_ns) {
  constexpr std::uint64_t kSecond = 1000000000;
  return Number(static_cast<std::uint32_t>(time_ns / kSecond)) +
         Number(static_cast<std::uint32_t>(time_ns % kSecond));
}

class Ros1BagWriter final : public BagWriter {
 public:
  explicit Ros1BagWriter(const std::string& path) : file_(path) {
    file_.Write("#ROSBAG V2.0\n");
    header_position_ = file_.position();
    file_.Write(BagHeader(0));
  }

  MessageEncoding Encoding() const override { return MessageEncoding::kRos1; }

  std::uint16_t AddTopic(const std::string& name, const RosType& type) override {
    const auto number = static_cast<std::uint16_t>(connections_.size());
    const bool is_latched = name == "/tf_static";
    connections_.push_back(Record(0x07, {{"conn", Number(std::uint32_t{number})}, {"topic", name}},
                                  Fields({{"topic", name},
                                          {"type", type.Ros1Name()},
                                          {"md5sum", type.md5sum},
                                          {"message_definition", DefinitionOf(type, Encoding())},
                                          {"latching", is_latched ? "1" : "0"}})));
    records_ += connections_.back();
    return number;
  }

  void Write(std::uint16_t topic, std::uint64_t time_ns, std::string_view message) override {
    index_[topic].emplace_back(time_ns, static_cast<std::uint32_t>(records_.size()));
    records_ +=
        Record(0x02, {{"conn", Number(std::uint32_t{topic})}, {"time", RosTime(time_ns)}}, message);
    if (records_.size() >= kChunk) WriteChunk();
  }

  void Close() override {
    if (!records_.empty()) WriteChunk();
    const std::uint64_t index = file_.position();
    for (const std::string& connection : connections_) file_.Write(connection);
    for (const std::string& info : chunk_infos_) file_.Write(info);
    file_.WriteAt(header_position_, BagHeader(index));
    file_.Close();
  }

 private:
  /// Of fixed length, since it is written again when the bag is closed.
  std::string BagHeader(std::uint64_t index) const {
    const FieldList fields = {
        {"index_pos", Number(index)},
        {"conn_count", Number(static_cast<std::uint32_t>(connections_.size()))},
        {"chunk_count", Number(static_cast<std::uint32_t>(chunk_infos_.size()))}};
    const std::size_t bare = Record(0x03, fields, "").size();
    return Record(0x03, fields, std::string(kBagHeader + 8 - bare, ' '));
  }

  void WriteChunk() {
    const std::uint64_t position = file_.position();
    file_.Write(Record(
        0x05,
        {{"compression", "none"}, {"size", Number(static_cast<std::uint32_t>(records_.size()))}},
        records_));
    std::uint64_t start = index_.empty() ? 0 : ~std::uint64_t{0};
    std::uint64_t end = 0;
    std::string counts;
    for (const auto& [topic, entries] : index_) {
      std::string list;
      for (const auto& [time, offset] : entries) {
        start = std::min(start, time);
        end = std::max(end, time);
        list += RosTime(time) + Number(offset);
      }
      const std::string connection = Number(std::uint32_t{topic});
      const std::string count = Number(static_cast<std::uint32_t>(entries.size()));
      file_.Write(Record(
          0x04, {{"ver", Number(std::uint32_t{1})}, {"conn", connection}, {"count", count}}, list));
      counts += connection + count;
    }
    chunk_infos_.push_back(Record(0x06,
                                  {{"ver", Number(std::uint32_t{1})},
                                   {"chunk_pos", Number(position)},
                                   {"start_time", RosTime(start)},
                                   {"end_time", RosTime(end)},
                                   {"count", Number(static_cast<std::uint32_t>(index_.size()))}},
                                  counts));
    records_.clear();
    index_.clear();
  }

  OutputBytes file_;
  std::uint64_t header_position_ = 0;
  std::vector<std::string> connections_;  ///< as records
  std::vector<std::string> chunk_infos_;  ///< as records
  std::string records_;                   ///< of the chunk that is being filled
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint32_t>>> index_;
};

}  // namespace

std::unique_ptr<BagWriter> CreateRos1Bag(const std::string& path) {
  return std::make_unique<Ros1BagWriter>(path);
}

}  // namespace masked_mapper
