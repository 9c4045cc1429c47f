// SPDX-License-Identifier: BSD-3-Clause
// The text of a log, decompressed a few blocks ahead by a thread of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "masked_mapper/log/run_ahead.hpp"
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
  explicit TextAhead(const std::string& path);

  /// Empty behind the last. Throws what the reading threw.
  std::optional<TextBlock> Next() { return blocks_.Next(); }

 private:
  void Read(const RunAhead<TextBlock>::Sink& sink);

  TextSource source_;
  RunAhead<TextBlock> blocks_;
};

}  // namespace masked_mapper
