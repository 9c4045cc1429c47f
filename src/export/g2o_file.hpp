// SPDX-License-Identifier: BSD-3-Clause
// The pose graph as VERTEX_SE2 and EDGE_SE2 lines and nothing else: readers differ in what they
// make of comments and of FIX. Stamps are in nodes.tum, where line i is vertex i.
#pragma once

#include <filesystem>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

/// All floors. g2o has the information of an edge in the frame of its far end, so it is turned
/// there from ours. Throws std::runtime_error when the file cannot be written.
void WriteG2o(const PoseGraph& graph, const std::filesystem::path& path);

/// One floor, its vertices under the same ids.
void WriteG2o(const PoseGraph& graph, FloorId floor, const std::filesystem::path& path);

}  // namespace masked_mapper
