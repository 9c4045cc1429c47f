// SPDX-License-Identifier: BSD-3-Clause
// An edge that tells how two nodes are turned to each other, and nothing of where they lie.
#pragma once

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// Of kind odometry, as what any two nodes may be joined by. `turn_rad`: from the heading of `from`
/// to that of `to`.
Edge HeadingTie(NodeId from, NodeId to, double turn_rad, double sigma_rad);

bool IsHeadingTie(const Edge& edge);

}  // namespace masked_mapper
