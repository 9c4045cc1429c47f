// SPDX-License-Identifier: BSD-3-Clause
// The messages of one file of a ROS 2 bag that is stored in SQLite (.db3), in the order of
// recording; each may be packed with zstd on its own (rosbag2's `--compression-mode message`).
//
// A file from elsewhere is opened read-only, its tables must be plain ones, a value has a greatest
// size, and a step a greatest length, so that no schema can keep the reader busy.
#pragma once

#include <memory>
#include <string>

#include "ros_bag.hpp"

namespace masked_mapper {

/// Throws InputError, with `shown_name` for the file: no bag, cannot be opened.
std::unique_ptr<RosBag> OpenSqliteBag(const std::string& path, const std::string& shown_name);

}  // namespace masked_mapper
