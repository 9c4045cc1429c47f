// SPDX-License-Identifier: BSD-3-Clause
#include "number_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace masked_mapper {

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
