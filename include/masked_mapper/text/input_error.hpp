// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace masked_mapper {

/// The user's input is at fault. The message is one clear line: which file, line or key, and what
/// was expected. The program prints it and exits with code 2; the library neither prints nor exits.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Letters to insert, delete, replace or swap with their neighbour to turn one name into the other.
std::size_t EditDistance(std::string_view a, std::string_view b);

/// " (did you mean `nearest`?)" for the known name nearest to the unknown one (ties: the first), or
/// nothing when none is near: more than a third of its letters differ.
std::string DidYouMean(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace masked_mapper
