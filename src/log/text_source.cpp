// SPDX-License-Identifier: BSD-3-Clause
#include "text_source.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

#include "masked_mapper/text/input_error.hpp"
#include "regular_file.hpp"
#include "unpacking.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kFileBlock = 128 * 1024;

}  // namespace

class TextSource::Impl {
 public:
  explicit Impl(const std::string& path) : file_(path, path), input_(kFileBlock) {
    Refill();
    packing_ = PackingHere();
    if (packing_ != Packing::kGzip && file_.size() > 0 &&
        std::filesystem::path(path).extension() == ".gz") {
      throw InputError(path + ": named .gz, but not gzip");
    }
    unpacker_ = MakeUnpacker(packing_);
  }

  std::size_t Read(char* buffer, std::size_t capacity) {
    return IsPacked() ? ReadPacked(buffer, capacity) : ReadPlain(buffer, capacity);
  }

  bool IsPacked() const { return packing_ != Packing::kNone; }
  bool truncated() const { return truncated_; }
  std::uint64_t trailing_bytes() const { return trailing_bytes_; }
  double Progress() const {
    if (file_.size() == 0) return 1.0;
    const std::uint64_t consumed = bytes_read_ - (input_end_ - input_begin_);
    return std::min(1.0, static_cast<double>(consumed) / static_cast<double>(file_.size()));
  }

 private:
  /// Tops the input block up; false when the file has no more to give.
  bool Refill() {
    std::memmove(input_.data(), input_.data() + input_begin_, input_end_ - input_begin_);
    input_end_ -= input_begin_;
    input_begin_ = 0;
    const std::size_t count =
        file_.ReadSome(input_.data() + input_end_, input_.size() - input_end_);
    input_end_ += count;
    bytes_read_ += count;
    return count > 0;
  }

  Packing PackingHere() const {
    return PackingOf(input_.data() + input_begin_, input_end_ - input_begin_);
  }

  std::size_t ReadPlain(char* buffer, std::size_t capacity) {
    std::size_t filled = 0;
    while (filled < capacity) {
      if (input_begin_ == input_end_ && !Refill()) break;
      const std::size_t count = std::min(capacity - filled, input_end_ - input_begin_);
      std::memcpy(buffer + filled, input_.data() + input_begin_, count);
      input_begin_ += count;
      filled += count;
    }
    return filled;
  }

  std::size_t ReadPacked(char* buffer, std::size_t capacity) {
    auto* out = reinterpret_cast<unsigned char*>(buffer);
    std::size_t room = capacity;
    while (room > 0 && unpacker_) {
      // Even without a byte left, what was taken in before may not be out yet.
      if (input_begin_ == input_end_) Refill();
      const unsigned char* in = input_.data() + input_begin_;
      std::size_t in_size = input_end_ - input_begin_;
      const std::size_t room_before = room;
      const std::size_t in_before = in_size;
      const Unpacker::State state = unpacker_->Unpack(&in, &in_size, &out, &room);
      input_begin_ = input_end_ - in_size;
      if (state == Unpacker::State::kEnd) {
        BeginNextStream();
      } else if (state == Unpacker::State::kBroken ||
                 (room == room_before && in_size == in_before)) {
        StopUnpacking(true);
      }
    }
    return capacity - room;
  }

  /// Packed files may be concatenated; anything else behind a stream is ignored, as gzip itself
  /// does.
  void BeginNextStream() {
    constexpr std::size_t kLongestMagic = 5;
    if (input_end_ - input_begin_ < kLongestMagic) Refill();
    const Packing next = PackingHere();
    if (next == packing_) {
      unpacker_->Restart();
      return;
    }
    trailing_bytes_ =
        file_.size() - std::min(file_.size(), bytes_read_ - (input_end_ - input_begin_));
    StopUnpacking(false);
  }

  void StopUnpacking(bool truncated) {
    truncated_ = truncated;
    unpacker_.reset();
    input_begin_ = input_end_;
  }

  RegularFile file_;
  std::vector<unsigned char> input_;
  std::size_t input_begin_ = 0;
  std::size_t input_end_ = 0;
  std::uint64_t bytes_read_ = 0;
  Packing packing_ = Packing::kNone;
  std::unique_ptr<Unpacker> unpacker_;  ///< while it has something to give
  bool truncated_ = false;
  std::uint64_t trailing_bytes_ = 0;
};

TextSource::TextSource(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
TextSource::~TextSource() = default;

std::size_t TextSource::Read(char* buffer, std::size_t capacity) {
  return impl_->Read(buffer, capacity);
}
bool TextSource::IsPacked() const { return impl_->IsPacked(); }
bool TextSource::Truncated() const { return impl_->truncated(); }
std::uint64_t TextSource::TrailingBytes() const { return impl_->trailing_bytes(); }
double TextSource::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
