// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace masked_mapper {

inline bool EndsWith(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() && text.substr(text.size() - ending.size()) == ending;
}

}  // namespace masked_mapper
