// SPDX-License-Identifier: BSD-3-Clause
// Masks by name, and expressions of them: `openings`, `any(openings,eccentricity)`, `not(never)`.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/masks/mask.hpp"
#include "masked_mapper/masks/mask_options.hpp"

namespace masked_mapper {

using MaskFactory = std::function<std::unique_ptr<Mask>(const MaskOptions&)>;

/// Adds a mask under a name ([a-z0-9_]+, not a combination's); true, so that one line at namespace
/// scope registers a user's mask. A bad name, or one taken twice, is the caller's bug:
/// std::logic_error.
bool RegisterMask(const std::string& name, MaskFactory factory);

/// The names that an expression may use, sorted.
std::vector<std::string> RegisteredMasks();

/// Builds the mask of an expression. Throws InputError with one line that says what is
/// wrong and where ("unknown mask `openingz` (did you mean `openings`?)").
std::unique_ptr<Mask> MakeMask(const std::string& expression, const MaskOptions& options);

}  // namespace masked_mapper
