// SPDX-License-Identifier: BSD-3-Clause
#include "ros2_bag_file.hpp"

#include <cstdint>
#include <utility>

#include "sqlite_messages.hpp"
#include "unpacking.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kLargestMessage = std::size_t{64} << 20U;

class Ros2BagFile final : public RosBag {
 public:
  Ros2BagFile(const std::string& path, const std::string& shown_name) : file_(path, shown_name) {
    for (const auto& [id, topic] : file_.topics()) {
      const auto number = static_cast<std::uint32_t>(connections_.size());
      connections_.emplace(number, topic);
      numbers_.emplace(id, number);
    }
  }

  std::optional<BagMessage> Next() override {
    while (const auto row = file_.Next()) {
      const auto number = numbers_.find(row->topic);
      BagMessage message;
      message.data = row->data;
      message.size = row->size;
      // What CDR begins with is no magic.
      if (PackingOf(row->data, row->size) == Packing::kZstd && !Unpack(&message)) message.size = 0;
      if (number == numbers_.end() || message.size == 0) {
        ++damaged_;
        continue;
      }
      message.connection = number->second;
      message.time = 1e-9 * static_cast<double>(row->time);
      message.encoding = MessageEncoding::kCdr;
      return message;
    }
    return std::nullopt;
  }

  void Rewind() override {
    file_.Rewind();
    damaged_ = 0;
  }

  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override { return true; }
  std::optional<double> EndTime() const override {
    return 1e-9 * static_cast<double>(file_.last_time());
  }
  bool Truncated() const override { return file_.damaged(); }
  std::uint64_t Damaged() const override { return damaged_; }
  double Progress() const override { return file_.Progress(); }

 private:
  bool Unpack(BagMessage* message) {
    if (!unpacker_) unpacker_ = MakeUnpacker(Packing::kZstd);
    const bool whole =
        UnpackAll(unpacker_.get(), message->data, message->size, kLargestMessage, &unpacked_);
    message->data = unpacked_.data();
    message->size = unpacked_.size();
    return whole;
  }

  SqliteMessages file_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::map<std::int64_t, std::uint32_t> numbers_;  ///< by the file's ids
  std::unique_ptr<Unpacker> unpacker_;
  Bytes unpacked_;
  std::uint64_t damaged_ = 0;
};

}  // namespace

std::unique_ptr<RosBag> OpenSqliteBag(const std::string& path, const std::string& shown_name) {
  return std::make_unique<Ros2BagFile>(path, shown_name);
}

}  // namespace masked_mapper
