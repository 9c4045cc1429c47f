// SPDX-License-Identifier: BSD-3-Clause
// The fields of a serialised ROS message, one after the other, of either version, as they are read
// and as they are written. Once one that is read does not fit, nothing does, and good() is false.
// Counts are checked before anything is allocated.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast_cdr.hpp"
#include "output_bytes.hpp"
#include "ros_messages.hpp"

namespace masked_mapper {

constexpr std::size_t kLongestFrameId = 256;
constexpr std::uint64_t kNanoseconds = 1000000000;  // of a second

/// As ROS 1 wrote it, without the leading slash.
inline std::string FrameId(std::string frame) {
  return frame.empty() || frame.front() != '/' ? frame : frame.substr(1);
}

struct ByteView {
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

/// ROS 1: little-endian, arrays and strings with their length before them.
class Ros1Fields {
 public:
  Ros1Fields(const unsigned char* data, std::size_t size) : data_(data), left_(size) {}

  bool good() const { return good_; }

  template <typename T>
  T Number() {
    T value{};
    const unsigned char* bytes = Take(sizeof(T));
    // ROS is little-endian, and so is every machine that this is built for.
    if (bytes != nullptr) std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  template <typename T>
  void Skip(std::size_t count) {
    Take(count * sizeof(T));
  }

  /// The number of elements of at least `element_size` bytes each that follow.
  std::size_t Count(std::size_t element_size) {
    const auto count = Number<std::uint32_t>();
    if (count > left_ / element_size) good_ = false;
    return good_ ? count : 0;
  }

  std::string String() {
    const std::size_t size = Count(1);
    const unsigned char* bytes = Take(size);
    if (bytes == nullptr || size > kLongestFrameId) return {};
    return {reinterpret_cast<const char*>(bytes), size};
  }

  std::vector<float> Floats() {
    const std::size_t count = Count(sizeof(float));
    const unsigned char* bytes = Take(count * sizeof(float));
    std::vector<float> values(bytes == nullptr ? 0 : count);
    if (!values.empty()) std::memcpy(values.data(), bytes, count * sizeof(float));
    return values;
  }

  /// Valid as long as the message is.
  ByteView Bytes() {
    const std::size_t count = Count(1);
    const unsigned char* bytes = Take(count);
    return bytes == nullptr ? ByteView{} : ByteView{bytes, count};
  }

  RosHeader Header() {
    RosHeader header;
    Number<std::uint32_t>();  // seq
    const auto seconds = Number<std::uint32_t>();
    const auto nanoseconds = Number<std::uint32_t>();
    header.stamp = static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
    header.frame_id = FrameId(String());
    return header;
  }

 private:
  const unsigned char* Take(std::size_t count) {
    if (!good_ || count > left_) {
      good_ = false;
      return nullptr;
    }
    const unsigned char* bytes = data_;
    data_ += count;
    left_ -= count;
    return bytes;
  }

  const unsigned char* data_;
  std::size_t left_;
  bool good_ = true;
};

/// ROS 2: CDR, of either byte order, each number aligned to its size. The library checks single
/// fields.
class CdrFields {
 public:
  CdrFields(const unsigned char* data, std::size_t size)
      : data_(data),
        size_(size),
        // Read only, but the library knows no such buffer.
        buffer_(const_cast<char*>(reinterpret_cast<const char*>(data)), size),
        cdr_(buffer_, Cdr::DEFAULT_ENDIAN, kDdsCdr) {
    Try([this] { cdr_.read_encapsulation(); });
  }

  bool good() const { return good_; }

  template <typename T>
  T Number() {
    T value{};
    Try([this, &value] { cdr_ >> value; });
    return good_ ? value : T{};
  }

  template <typename T>
  void Skip(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) Number<T>();
  }

  std::size_t Count(std::size_t element_size) {
    const auto count = Number<std::uint32_t>();
    if (good_ && count > (size_ - LengthOf(cdr_)) / element_size) good_ = false;
    return good_ ? count : 0;
  }

  std::string String() {
    std::string text = Array<std::string>(Count(1), '\0');
    while (!text.empty() && text.back() == '\0') text.pop_back();
    if (text.size() > kLongestFrameId) text.clear();
    return text;
  }

  std::vector<float> Floats() { return Array<std::vector<float>>(Count(sizeof(float)), 0.0F); }

  ByteView Bytes() {
    const std::size_t count = Count(1);
    const ByteView bytes{data_ + LengthOf(cdr_), count};
    Try([this, count] {
      if (!cdr_.jump(count)) good_ = false;
    });
    return good_ ? bytes : ByteView{};
  }

  RosHeader Header() {
    RosHeader header;
    const auto seconds = Number<std::int32_t>();
    const auto nanoseconds = Number<std::uint32_t>();
    header.stamp = static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
    header.frame_id = FrameId(String());
    return header;
  }

 private:
  template <typename Read>
  void Try(const Read& read) {
    if (!good_) return;
    try {
      read();
    } catch (const eprosima::fastcdr::exception::Exception&) {
      good_ = false;
    }
  }

  template <typename Values, typename T>
  Values Array(std::size_t count, T empty) {
    Values values(count, empty);
    if (count > 0) Try([this, &values, count] { ReadArray(cdr_, values.data(), count); });
    return good_ ? values : Values{};
  }

  const unsigned char* data_;
  std::size_t size_;
  eprosima::fastcdr::FastBuffer buffer_;
  Cdr cdr_;
  bool good_ = true;
};

/// ns of a stamp, to a microsecond: more a double does not hold.
inline std::uint64_t NanosecondsOf(double stamp) {
  return stamp > 0.0 ? static_cast<std::uint64_t>(std::llround(stamp * 1e6)) * 1000 : 0;
}

/// The inverse of Ros1Fields.
class Ros1Output {
 public:
  template <typename T>
  void Number(T value) {
    AppendNumber(value, &bytes_);
  }
  void String(const std::string& text) { AppendString(text, &bytes_); }
  /// Without their count.
  void Bytes(const std::string& bytes) { bytes_ += bytes; }
  void Header(const RosHeader& header) {
    Number(std::uint32_t{0});  // seq
    const std::uint64_t time = NanosecondsOf(header.stamp);
    Number(static_cast<std::uint32_t>(time / kNanoseconds));
    Number(static_cast<std::uint32_t>(time % kNanoseconds));
    String(header.frame_id);
  }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// The inverse of CdrFields, little-endian. The library leaves what it skips to align as it was in
/// memory, and the same messages would not be the same bytes.
class CdrOutput {
 public:
  template <typename T>
  void Number(T value) {
    while ((bytes_.size() - kEncapsulation.size()) % sizeof(T) != 0) bytes_.push_back('\0');
    AppendNumber(value, &bytes_);
  }
  void String(const std::string& text) {
    Number(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.append(text.c_str(), text.size() + 1);
  }
  void Bytes(const std::string& bytes) { bytes_ += bytes; }
  void Header(const RosHeader& header) {
    const std::uint64_t time = NanosecondsOf(header.stamp);
    Number(static_cast<std::int32_t>(time / kNanoseconds));
    Number(static_cast<std::uint32_t>(time % kNanoseconds));
    String(header.frame_id);
  }
  std::string Take() { return std::move(bytes_); }

 private:
  static constexpr std::string_view kEncapsulation{"\0\1\0\0", 4};

  std::string bytes_{kEncapsulation};
};

}  // namespace masked_mapper
