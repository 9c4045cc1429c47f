// SPDX-License-Identifier: BSD-3-Clause
// The paper's path-length error (Section IV): random pairs of stamps are placed on the map between
// the nodes before and after them, and the shortest way between the two along the graph is compared
// with the true one. Missing closures make ways longer, false ones shorter; the two are told apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "masked_mapper/evaluation/closures.hpp"
#include "masked_mapper/evaluation/error_statistics.hpp"
#include "masked_mapper/evaluation/result_folder.hpp"

namespace masked_mapper {

struct PathLengthOptions {
  std::size_t pairs = 999;  ///< of the paper
  std::uint64_t seed = 1;
  RevisitOptions revisits;
};

struct PathLengthError {
  ErrorStatistics error_m;  ///< of the magnitude, over all pairs
  double missing_m = 0.0;   ///< mean over all pairs of what is too long
  double false_m = 0.0;     ///< mean over all pairs of what is too short; the two sum to the mean
};

/// The true graph has the map's nodes at their true poses. What ties them is the drive itself,
/// every true revisit, and those of the map's own edges whose true length is the map's within
/// `tolerance`; so a revisit that the map did not close makes the true way shorter, and a false
/// closure the map's. Lengths are in the plane: a ride in an elevator has none. A step of the drive
/// with an end whose truth is not known counts with the map's length.
///
/// Nothing when there are fewer than two nodes, or no node's truth is known.
std::optional<PathLengthError> ComparePathLengths(
    const MappedGraph& graph, const std::vector<std::optional<StampedPose>>& truth,
    const ClosureTolerance& tolerance, const PathLengthOptions& options = {});

}  // namespace masked_mapper
