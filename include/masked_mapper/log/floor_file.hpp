// SPDX-License-Identifier: BSD-3-Clause
// Floors as said by a file beside the log: lines `t,label`, from t (s) on the robot is on that
// floor; `-` means in transit. A heading `t,label`, blank lines and lines with `#` are left out.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// Whether a floor's label may become a file name (DESIGN, Command line); `-` (in transit) is one
/// here.
bool IsFloorLabel(const std::string& label);

/// In order of stamps. Throws InputError, which names file and line, when the file cannot be read,
/// a line is not of this form, a label may not become a file name, stamps step back, or no line
/// says a floor.
std::vector<FloorLabel> ReadFloorFile(const std::string& path);

}  // namespace masked_mapper
