// SPDX-License-Identifier: BSD-3-Clause
// A bag of any kind by what it is, not by its name.
#pragma once

#include <memory>
#include <string>

#include "masked_mapper/log/ros_bag.hpp"

namespace masked_mapper {

bool IsBag(const std::string& path);

/// Throws InputError: none, or of a version that is not read.
std::unique_ptr<RosBag> OpenBag(const std::string& path);

}  // namespace masked_mapper
