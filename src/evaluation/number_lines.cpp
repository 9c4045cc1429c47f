// SPDX-License-Identifier: BSD-3-Clause
#include "number_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "masked_mapper/log/line_splitter.hpp"
#include "masked_mapper/log/text_source.hpp"
#include "masked_mapper/text/input_error.hpp"

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

std::vector<std::string_view> WordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(" \t"); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(" \t", end);
  }
  return words;
}

double NumberIn(std::string_view word, const FileLine& line) {
  const std::string_view digits =
      !word.empty() && word.front() == '+' ? word.substr(1) : word;  // from_chars knows no plus
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    line.Fail("`" + std::string(word.substr(0, 40)) + "` is no finite number");
  }
  return value;
}

}  // namespace masked_mapper
