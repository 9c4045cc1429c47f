// SPDX-License-Identifier: BSD-3-Clause
#include "floor_label.hpp"

#include <set>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

bool IsFileName(const std::string& label) {
  static constexpr const char* kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";
  return !label.empty() && label.size() <= 100 && label != "." && label != ".." &&
         label.find_first_not_of(kAllowed) == std::string::npos;
}

void CheckFloorLabels(const std::vector<Floor>& floors) {
  std::set<std::string> seen;
  for (const Floor& floor : floors) {
    if (!IsFileName(floor.label)) {
      throw InputError("floor label '" + floor.label +
                       "' cannot name a file: use letters, digits, '_', '.' and '-'");
    }
    if (!seen.insert(floor.label).second) {
      throw InputError("two floors have the label '" + floor.label + "'");
    }
  }
}

}  // namespace masked_mapper
