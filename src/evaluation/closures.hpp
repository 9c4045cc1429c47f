// SPDX-License-Identifier: BSD-3-Clause
// Loop closures against the truth: which of the validated ones are false, and how many of the pairs
// of nodes that could be closed are.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "masked_mapper/evaluation/evaluation.hpp"
#include "result_folder.hpp"
#include "truth.hpp"

namespace masked_mapper {

struct ClosureTolerance {
  double translation_m = 0.5;
  double rotation_deg = 5.0;
};

/// How far a true closure may be off: 0.5 m and 5 degrees where the truth is exact, 1 m and 15
/// degrees where it is a reference trajectory.
ClosureTolerance ToleranceOf(const Truth& truth);

/// Which pairs of nodes are revisits, and when they count as closed. Ours to choose.
struct RevisitOptions {
  double distance_m = 2.0;
  double heading_deg = 45.0;
  double travel_m = 20.0;  ///< along the drive between them, at least
  /// A pair is closed when the graph joins its two nodes by a walk of at most this length over
  /// true closures (a neighbour's closure closes it too).
  double walk_m = 10.0;
};

/// Pairs (earlier, later) of nodes that truly lie close together on one floor, seen in much the
/// same direction, after a way around. Nodes on either side of a floor change are left out: they
/// hold no scan.
std::vector<std::pair<std::size_t, std::size_t>> TrueRevisits(
    const std::vector<StampedPose>& nodes, const std::vector<std::optional<StampedPose>>& truth,
    const RevisitOptions& options = {});

/// `truth` is that of the graph's nodes.
ClosureError CheckClosures(const MappedGraph& graph, const std::vector<ValidatedClosure>& closures,
                           const std::vector<std::optional<StampedPose>>& truth,
                           const ClosureTolerance& tolerance, const RevisitOptions& options = {});

}  // namespace masked_mapper
