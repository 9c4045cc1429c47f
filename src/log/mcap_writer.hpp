// SPDX-License-Identifier: BSD-3-Clause
// An MCAP file of ROS 2 messages, its chunks packed with zstd, with all indexes and checksums.
#pragma once

#include <memory>
#include <string>

#include "bag_writer.hpp"

namespace masked_mapper {

std::unique_ptr<BagWriter> CreateMcap(const std::string& path);

}  // namespace masked_mapper
