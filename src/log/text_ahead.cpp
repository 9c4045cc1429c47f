// SPDX-License-Identifier: BSD-3-Clause
#include "text_ahead.hpp"

#include <utility>

namespace masked_mapper {
namespace {

constexpr std::size_t kTextBlock = 256 * 1024;

}  // namespace

TextAhead::~TextAhead() {
  blocks_.Close();
  thread_.join();
}

std::optional<TextBlock> TextAhead::Next() {
  std::optional<TextBlock> block = blocks_.Pop();
  if (!block && error_) std::rethrow_exception(error_);
  return block;
}

void TextAhead::Read() {
  try {
    bool more = true;
    while (more) {
      TextBlock block;
      block.text.resize(kTextBlock);
      const std::size_t count = source_.Read(block.text.data(), block.text.size());
      block.text.resize(count);
      block.is_last = count < kTextBlock;
      block.progress = block.is_last ? 1.0 : source_.Progress();
      block.truncated = source_.Truncated();
      block.trailing_bytes = source_.TrailingBytes();
      more = !block.is_last;
      more = blocks_.Push(std::move(block)) && more;
    }
  } catch (...) {
    error_ = std::current_exception();
  }
  blocks_.Close();
}

}  // namespace masked_mapper
