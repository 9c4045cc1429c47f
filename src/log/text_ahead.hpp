// SPDX-License-Identifier: BSD-3-Clause
// The text of a log, decompressed a few blocks ahead by a thread of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <thread>

#include "bounded_queue.hpp"
#include "text_source.hpp"

namespace masked_mapper {

struct TextBlock {
  std::string text;
  double progress = 0.0;
  bool is_last = false;
  bool truncated = false;
  std::uint64_t trailing_bytes = 0;
};

class TextAhead {
 public:
  /// Throws InputError as TextSource does.
  explicit TextAhead(const std::string& path) : source_(path), thread_([this] { Read(); }) {}
  ~TextAhead();

  /// Empty behind the last. Throws what the reading threw.
  std::optional<TextBlock> Next();

 private:
  static constexpr std::size_t kBlocksAhead = 4;

  void Read();

  TextSource source_;
  BoundedQueue<TextBlock> blocks_{kBlocksAhead};
  std::exception_ptr error_;  ///< written before the queue is closed, read after
  std::thread thread_;
};

}  // namespace masked_mapper
