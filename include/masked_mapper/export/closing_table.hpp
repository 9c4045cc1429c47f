// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "masked_mapper/export/summary_file.hpp"

namespace masked_mapper {

/// The summary as lines for people: nodes, closures and why others were rejected, floors, seconds
/// per stage and memory.
std::string ClosingTable(const Summary& summary);

}  // namespace masked_mapper
