// SPDX-License-Identifier: BSD-3-Clause
// What a user who mistyped a name probably meant, for the one clear line of an InputError.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace masked_mapper {

/// Letters to insert, delete, replace or swap with their neighbour to turn one name into the other.
std::size_t EditDistance(std::string_view a, std::string_view b);

/// " (did you mean `nearest`?)" for the known name nearest to the unknown one (ties: the first), or
/// nothing when none is near: more than a third of its letters differ.
std::string DidYouMean(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace masked_mapper
