// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/text_lines.hpp"

#include <vector>

#include "line_splitter.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "text_source.hpp"

namespace masked_mapper {

void FileLine::Fail(const std::string& reason) const {
  throw InputError(path + ":" + std::to_string(number) + ": " + reason);
}

void ForEachLine(const std::string& path,
                 const std::function<void(std::string_view, const FileLine&)>& on_line) {
  constexpr std::size_t kLongestLine = 65536;
  TextSource source(path);
  LineSplitter splitter;
  std::size_t number = 0;
  const auto take = [&](const char* begin, const char* end, bool too_long) {
    const FileLine line{path, ++number};
    const auto length = static_cast<std::size_t>(end - begin);
    if (too_long || length > kLongestLine) line.Fail("the line is too long");
    std::string_view text(begin, length);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    on_line(text, line);
  };
  std::vector<char> block(std::size_t{1} << 16);
  for (std::size_t got = block.size(); got == block.size();) {
    got = source.Read(block.data(), block.size());
    splitter.Add({block.data(), got}, take);
  }
  splitter.Finish(take);
  if (source.Truncated()) throw InputError(path + ": the file is cut off or damaged");
}

}  // namespace masked_mapper
