// SPDX-License-Identifier: BSD-3-Clause
// A ROS 1 bag of version 2.0 as it is written, its chunks plain.
#pragma once

#include <memory>
#include <string>

#include "bag_writer.hpp"

namespace masked_mapper {

std::unique_ptr<BagWriter> CreateRos1Bag(const std::string& path);

}  // namespace masked_mapper
