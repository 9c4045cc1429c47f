// SPDX-License-Identifier: BSD-3-Clause
// Labels of floors become names of files.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// Letters, digits, `_`, `.` and `-`; neither empty nor `.` nor `..`, at most 100 characters.
bool IsFileName(const std::string& label);

/// Throws InputError when a label cannot name a file, or two floors share one.
void CheckFloorLabels(const std::vector<Floor>& floors);

}  // namespace masked_mapper
