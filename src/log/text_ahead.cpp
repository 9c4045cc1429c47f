// SPDX-License-Identifier: BSD-3-Clause
#include "text_ahead.hpp"

#include <utility>

namespace masked_mapper {
namespace {

constexpr std::size_t kTextBlock = 256 * 1024;
constexpr std::size_t kBlocksAhead = 4;

}  // namespace

TextAhead::TextAhead(const std::string& path)
    : source_(path), blocks_(kBlocksAhead, [this](const auto& sink) { Read(sink); }) {}

void TextAhead::Read(const RunAhead<TextBlock>::Sink& sink) {
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
    more = sink(std::move(block)) && more;
  }
}

}  // namespace masked_mapper
