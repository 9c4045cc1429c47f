// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/drives.hpp"

#include <algorithm>
#include <numeric>

namespace masked_mapper {
namespace {

// The last drive that begins at or before `index`.
template <typename First>
std::size_t DriveAt(const std::vector<Drive>& drives, std::size_t index, First first) {
  std::size_t drive = 0;
  while (drive + 1 < drives.size() && first(drives[drive + 1]) <= index) ++drive;
  return drive;
}

std::size_t FirstNode(const Drive& drive) { return static_cast<std::size_t>(drive.first_node); }
std::size_t FirstPose(const Drive& drive) { return drive.first_pose; }

}  // namespace

std::size_t DriveOfNode(const BuildingMap& map, NodeId node) {
  return DriveAt(map.drives, static_cast<std::size_t>(node), FirstNode);
}

std::size_t DriveOfPose(const BuildingMap& map, std::size_t trajectory_index) {
  return DriveAt(map.drives, trajectory_index, FirstPose);
}

IndexRange NodesOfDrive(const BuildingMap& map, std::size_t drive) {
  if (map.drives.empty()) return {0, map.graph.nodes().size()};
  return {FirstNode(map.drives.at(drive)), drive + 1 < map.drives.size()
                                               ? FirstNode(map.drives[drive + 1])
                                               : map.graph.nodes().size()};
}

IndexRange PosesOfDrive(const BuildingMap& map, std::size_t drive) {
  if (map.drives.empty()) return {0, map.trajectory.size()};
  return {FirstPose(map.drives.at(drive)),
          drive + 1 < map.drives.size() ? FirstPose(map.drives[drive + 1]) : map.trajectory.size()};
}

std::vector<std::size_t> PiecesOfDrives(const BuildingMap& map) {
  // Each drive hangs together by its motion: only closures between drives tell pieces apart.
  std::vector<std::size_t> root(std::max<std::size_t>(1, map.drives.size()));
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto root_of = [&](std::size_t drive) {
    while (root[drive] != drive) drive = root[drive];
    return drive;
  };
  for (const Edge& edge : map.graph.edges()) {
    const std::size_t one = root_of(DriveOfNode(map, edge.from));
    const std::size_t other = root_of(DriveOfNode(map, edge.to));
    root[std::max(one, other)] = std::min(one, other);
  }
  std::vector<std::size_t> piece(root.size());
  std::size_t pieces = 0;
  for (std::size_t drive = 0; drive < root.size(); ++drive) {
    piece[drive] = root_of(drive) == drive ? pieces++ : piece[root_of(drive)];
  }
  return piece;
}

std::vector<DriveFacts> FactsOfDrives(const BuildingMap& map) {
  const std::vector<std::size_t> pieces = PiecesOfDrives(map);
  std::vector<DriveFacts> facts;
  for (std::size_t i = 0; i < map.drives.size(); ++i) {
    const IndexRange poses = PosesOfDrive(map, i);
    const IndexRange nodes = NodesOfDrive(map, i);
    DriveFacts drive;
    drive.log = map.drives[i].log;
    drive.piece = pieces[i];
    drive.joined = pieces[i] == 0;
    drive.scans = poses.end - poses.begin;
    drive.nodes = nodes.end - nodes.begin;
    drive.reason = map.drives[i].reason;
    drive.stamp_offset_s = map.drives[i].stamp_offset_s;
    std::vector<bool> seen(map.graph.floors().size(), false);
    for (std::size_t node = nodes.begin; node < nodes.end; ++node) {
      const auto floor = static_cast<std::size_t>(map.graph.nodes()[node].floor);
      if (!seen[floor]) drive.floors.push_back(map.graph.floors()[floor].label);
      seen[floor] = true;
    }
    facts.push_back(std::move(drive));
  }
  for (const Edge& edge : map.graph.edges()) {
    const std::size_t one = DriveOfNode(map, edge.from);
    const std::size_t other = DriveOfNode(map, edge.to);
    if (one == other || facts.empty()) continue;
    ++facts[one].closures_to_others;
    ++facts[other].closures_to_others;
  }
  return facts;
}

std::vector<std::string> WarningsOf(const BuildingMap& map) {
  std::vector<std::string> warnings = map.warnings;
  const std::vector<std::size_t> pieces = PiecesOfDrives(map);
  std::size_t told = 0;
  for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
    if (pieces[drive] <= told) continue;
    told = pieces[drive];
    warnings.push_back(map.drives[drive].log + ": stays a piece of its own, beside the others: " +
                       map.drives[drive].reason);
  }
  return warnings;
}

}  // namespace masked_mapper
