// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/input_error.hpp"

#include <algorithm>

namespace masked_mapper {

std::size_t EditDistance(std::string_view a, std::string_view b) {
  // Rows of the table of distances between prefixes: of a without its last two letters, without its
  // last, and whole.
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::string DidYouMean(std::string_view unknown, const std::vector<std::string>& known) {
  // The mistake may be a whole file on one line; no name is that long.
  constexpr std::size_t kLongest = 200;
  if (unknown.size() > kLongest) return {};
  const std::string* nearest = nullptr;
  std::size_t least = 0;
  for (const std::string& name : known) {
    const std::size_t distance = EditDistance(unknown, name);
    if (3 * distance > std::max(unknown.size(), name.size())) continue;
    if (nearest == nullptr || distance < least) {
      nearest = &name;
      least = distance;
    }
  }
  return nearest == nullptr ? std::string{} : " (did you mean `" + *nearest + "`?)";
}

}  // namespace masked_mapper
