// SPDX-License-Identifier: BSD-3-Clause
// The paper's path-length error (Section IV): random pairs of stamps are placed on the map between
// the nodes before and after them, and the shortest way between the two along the graph is compared
// with the true one. Missing closures make ways longer, false ones shorter; the two are told apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "closures.hpp"
#include "masked_mapper/evaluation/evaluation.hpp"
#include "result_folder.hpp"

namespace masked_mapper {

struct PathLengthOptions {
  std::size_t pairs = 999;  ///< of the paper
  std::uint64_t seed = 1;
  RevisitOptions revisits;
};

/// Two stamps of the drive, s.
struct StampPair {
  double from = 0.0;
  double to = 0.0;
};

/// Drawn evenly between the first and the last stamp of the log, so the same for every map of it.
std::vector<StampPair> DrawStampPairs(double first, double last,
                                      const PathLengthOptions& options = {});

/// The true graph has the map's nodes at their true poses. What ties them is the drive itself,
/// every true revisit, and those of the map's own edges whose true length is the map's within
/// `tolerance`; so a revisit that the map did not close makes the true way shorter, and a false
/// closure the map's. Lengths are in the plane: a ride in an elevator has none. A step of the drive
/// with an end whose truth is not known counts with the map's length.
///
/// Nothing when there are fewer than two nodes, no pairs, or no node's truth is known.
std::optional<PathLengthError> ComparePathLengths(
    const MappedGraph& graph, const std::vector<std::optional<StampedPose>>& truth,
    const std::vector<StampPair>& pairs, const ClosureTolerance& tolerance,
    const RevisitOptions& revisits = {});

/// The paper's own truth, for logs without a better one: the true way of a pair is the shortest
/// over the maps in `checked`, which are known to be free of false closures; `graph` may be one of
/// them. A closure that all of them missed stays hidden.
///
/// Nothing when a graph has fewer than two nodes, or there are no pairs or no checked maps.
std::optional<PathLengthError> CompareWithCheckedMaps(const MappedGraph& graph,
                                                      const std::vector<MappedGraph>& checked,
                                                      const std::vector<StampPair>& pairs);

}  // namespace masked_mapper
