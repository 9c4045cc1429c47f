// SPDX-License-Identifier: BSD-3-Clause
// The words of an enumeration. Beside it stand, by value and found by its type alone,
//
//   constexpr std::array<const char*, 2> NamesOf(Colour) { return {"red", "green"}; }
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace masked_mapper {

template <typename Enum>
const char* Name(Enum value) {
  return NamesOf(value).at(static_cast<std::size_t>(value));
}

/// Empty when no value is called so.
template <typename Enum>
std::optional<Enum> FromName(std::string_view name) {
  const auto names = NamesOf(Enum{});
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (name == names[i]) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace masked_mapper
