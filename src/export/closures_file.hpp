// SPDX-License-Identifier: BSD-3-Clause
// closures.csv: one line per pair that was offered to the matcher, and what became of it.
#pragma once

#include <filesystem>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Header t_a,t_b,floor,dx,dy,dtheta,score,maha,votes,state,reason; a is the newer node, dx, dy,
/// dtheta are T_a_b in metres and radians. Throws std::runtime_error when the file cannot be
/// written.
void WriteClosures(const std::vector<Closure>& closures, const PoseGraph& graph,
                   const std::filesystem::path& path);

}  // namespace masked_mapper
