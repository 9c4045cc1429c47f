// SPDX-License-Identifier: BSD-3-Clause
// What to tell the user of a bag that holds no scan.
#pragma once

#include <string>

#include "ros_bag.hpp"

namespace masked_mapper {

/// Its topics with their types and counts, for which it is read to its end, and what makes scans of
/// them where that is known.
std::string WhatIsThereInsteadOfScans(RosBag* bag);

/// What is wrong with it as far as it was read, as the end of a line: "; the file is cut off in the
/// middle". Empty: nothing.
std::string DamageOf(const RosBag& bag);

}  // namespace masked_mapper
