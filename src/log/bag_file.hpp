// SPDX-License-Identifier: BSD-3-Clause
// The records of a ROS 1 bag, format 2.0, read forward chunk by chunk; neither an index nor an end
// is needed, so that a bag whose recording was cut gives what it has. Every length in the file is
// checked before it is believed. (librosbag_storage reads by the index, uses its offsets unchecked,
// and its messages are resized to whatever count the file states: not for files of unknown origin.
// The tests hold this reader against it.)
#pragma once

#include <memory>
#include <string>

#include "ros_bag.hpp"

namespace masked_mapper {

/// Throws InputError, with `shown_name` for the file: cannot be opened, obsolete version,
/// encrypted, no bag.
std::unique_ptr<RosBag> OpenRos1Bag(const std::string& path, const std::string& shown_name);

}  // namespace masked_mapper
