// SPDX-License-Identifier: BSD-3-Clause
// The look at the beginning of a bag, as far as it takes to settle frames, clocks and the limit of
// the ranges.
#pragma once

#include <string>

#include "bag_plan.hpp"

namespace masked_mapper {

/// The plan with all that only messages tell. Throws InputError: a scanner without a scan that can
/// be read.
BagPlan LookAtBag(const std::string& path, const LogOptions& options, const BagPlan& topics,
                  RosBag* bag);

}  // namespace masked_mapper
