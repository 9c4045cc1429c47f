// SPDX-License-Identifier: BSD-3-Clause
// What `map` wrote, as far as evaluation needs it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stamped_trajectory.hpp"

namespace masked_mapper {

struct MappedFloor {
  std::string label;
  double elevation = 0.0;  ///< m
};

/// The floor whose elevation is nearest to a height; `floors` is not empty.
std::size_t NearestFloor(const std::vector<MappedFloor>& floors, double z);

/// Nodes by their place in nodes.tum.
struct GraphEdge {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// One line of closures.csv that is `validated`.
struct ValidatedClosure {
  std::size_t a = 0;  ///< the newer node
  std::size_t b = 0;
  Pose2 T_a_b;
};

/// The graph's nodes in order of driving: node i and i + 1 are tied by odometry or a floor change.
struct MappedGraph {
  std::vector<StampedPose> nodes;  ///< their stamps never step back
  std::vector<double> log_stamps;  ///< s, the same as the log gives them to the nodes' scans
  std::vector<GraphEdge> edges;    ///< all of graph.g2o
};

/// One log's part of a map of several; scans and nodes of drives follow each other.
struct MappedDrive {
  std::size_t scans = 0;
  std::size_t nodes = 0;
  double stamp_offset = 0.0;  ///< s, was added to the log's stamps for those of nodes
  std::vector<std::string> floors;
};

/// One line of trajectory.tum.
struct MappedScan {
  StampedPose pose;    ///< with the log's own stamp
  double stamp = 0.0;  ///< s, that nodes and closures go by; never steps back
};

struct ResultFolder {
  std::vector<MappedScan> scans;                          ///< in order of driving
  std::vector<StampedPose> trajectory;                    ///< the same in order of the log's stamps
  std::optional<MappedGraph> graph;                       ///< of nodes.tum and graph.g2o
  std::optional<std::vector<ValidatedClosure>> closures;  ///< of closures.csv, when `graph` is
  std::vector<MappedFloor> floors;                        ///< of summary.json
  std::vector<MappedDrive> drives;                        ///< the same; of one log: none
};

/// trajectory.tum must be there; of the others, what is there is read. Throws InputError, which
/// names file and line.
ResultFolder ReadResultFolder(const std::string& folder);

/// What a map of several logs holds of drive `number`, from 1: its scans, nodes, edges and closures
/// with both ends in it, and its floors, with the stamps of its own log. Throws InputError when
/// there is no such drive; `folder` is for the message.
ResultFolder OneDrive(const std::string& folder, const ResultFolder& result, std::size_t number);

}  // namespace masked_mapper
