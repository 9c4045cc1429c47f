// SPDX-License-Identifier: BSD-3-Clause
// A bag of any kind by what it is, not by its name: .bag, .db3, .mcap, each as it is or packed with
// gzip, bzip2 or zstd; or a folder of rosbag2, whose .db3 and .mcap files are one recording. Its
// metadata.yaml is written when the recording is closed, tells nothing that the files do not, and
// is not read.
#pragma once

#include <memory>
#include <string>

#include "ros_bag.hpp"

namespace masked_mapper {

/// Throws InputError: none of them, or of a version that is not read.
std::unique_ptr<RosBag> OpenBag(const std::string& path);

}  // namespace masked_mapper
