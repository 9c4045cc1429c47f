// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/ros2_bag_file.hpp"

#include <cstdint>
#include <utility>

#include "sqlite_messages.hpp"
#include "unpacking.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kLargestMessage = std::size_t{64} << 20U;

}  // namespace

class Ros2BagFile::Impl {
 public:
  Impl(const std::string& path, const std::string& shown_name) : file_(path, shown_name) {
    for (const auto& [id, topic] : file_.topics()) {
      const auto number = static_cast<std::uint32_t>(connections_.size());
      connections_.emplace(number, topic);
      numbers_.emplace(id, number);
    }
  }

  std::optional<BagMessage> Next() {
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

  void Rewind() {
    file_.Rewind();
    damaged_ = 0;
  }

  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  double end_time() const { return 1e-9 * static_cast<double>(file_.last_time()); }
  bool truncated() const { return file_.damaged(); }
  std::uint64_t damaged() const { return damaged_; }
  double Progress() const { return file_.Progress(); }

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

Ros2BagFile::Ros2BagFile(const std::string& path, const std::string& shown_name)
    : impl_(std::make_unique<Impl>(path, shown_name)) {}
Ros2BagFile::~Ros2BagFile() = default;

std::optional<BagMessage> Ros2BagFile::Next() { return impl_->Next(); }
void Ros2BagFile::Rewind() { impl_->Rewind(); }
const std::map<std::uint32_t, BagConnection>& Ros2BagFile::Connections() const {
  return impl_->connections();
}
std::optional<double> Ros2BagFile::EndTime() const { return impl_->end_time(); }
bool Ros2BagFile::Truncated() const { return impl_->truncated(); }
std::uint64_t Ros2BagFile::Damaged() const { return impl_->damaged(); }
double Ros2BagFile::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
