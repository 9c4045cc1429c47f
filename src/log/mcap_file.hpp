// SPDX-License-Identifier: BSD-3-Clause
// The messages of one MCAP file in the order of their time of logging, whatever the order of its
// chunks. Chunks that overlap in time are read side by side as far as memory allows.
#pragma once

#include <memory>
#include <string>

#include "ros_bag.hpp"

namespace masked_mapper {

/// Throws InputError, with `shown_name` for the file: cannot be opened, no MCAP of version 0.
std::unique_ptr<RosBag> OpenMcap(const std::string& path, const std::string& shown_name);

}  // namespace masked_mapper
