// SPDX-License-Identifier: BSD-3-Clause
// Cuts a stream of text blocks into lines. A line longer than a bound is given up without being
// stored, so that a file without newlines costs no memory.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace masked_mapper {

class LineSplitter {
 public:
  /// No message comes near: 1440 beams with remissions are 30 kB.
  static constexpr std::size_t kLongestLine = std::size_t{4} << 20;

  /// Calls `on_line(begin, end, too_long)` for each line that ends in this block; `*end` is a
  /// newline. Of a line too long only its beginning is given.
  template <typename OnLine>
  void Add(std::string_view block, const OnLine& on_line) {
    const char* cursor = block.data();
    const char* const end = cursor + block.size();
    while (cursor < end) {
      const auto* newline = static_cast<const char*>(
          std::memchr(cursor, '\n', static_cast<std::size_t>(end - cursor)));
      if (newline == nullptr) {
        Keep(cursor, end);
        return;
      }
      if (rest_.empty() && !too_long_) {
        on_line(cursor, newline, false);
      } else {
        Keep(cursor, newline);
        EmitRest(on_line);
      }
      cursor = newline + 1;
    }
  }

  /// The last line, when the text does not end in a newline; returns whether there was one.
  template <typename OnLine>
  bool Finish(const OnLine& on_line) {
    if (rest_.empty()) return false;
    EmitRest(on_line);
    return true;
  }

 private:
  void Keep(const char* begin, const char* end) {
    if (too_long_) return;
    rest_.append(begin, end);
    if (rest_.size() <= kLongestLine) return;
    too_long_ = true;
    rest_.resize(64);
    rest_.shrink_to_fit();
  }

  template <typename OnLine>
  void EmitRest(const OnLine& on_line) {
    rest_.push_back('\n');
    on_line(rest_.data(), rest_.data() + rest_.size() - 1, too_long_);
    rest_.clear();
    too_long_ = false;
  }

  std::string rest_;
  bool too_long_ = false;
};

}  // namespace masked_mapper
