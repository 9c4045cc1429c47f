// SPDX-License-Identifier: BSD-3-Clause
// Which part of a map comes from which log, and which of them hang together. A map of several logs
// is in pieces where no closure ties a drive to the others: each piece has floors of its own.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Drives, by place in BuildingMap::drives.
std::size_t DriveOfNode(const BuildingMap& map, NodeId node);
std::size_t DriveOfPose(const BuildingMap& map, std::size_t trajectory_index);

/// First and behind-the-last.
struct IndexRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};
IndexRange NodesOfDrive(const BuildingMap& map, std::size_t drive);
IndexRange PosesOfDrive(const BuildingMap& map, std::size_t drive);

/// The piece of every drive: the first drive's is 0, each new one counts on. Drives are in one
/// piece when closures tie them.
std::vector<std::size_t> PiecesOfDrives(const BuildingMap& map);

/// What people want to know of a drive.
struct DriveFacts {
  std::string log;
  bool joined = false;  ///< in one piece with the first drive
  std::size_t piece = 0;
  std::size_t scans = 0;
  std::size_t nodes = 0;
  std::size_t closures_to_others = 0;  ///< closures in the graph with one end in another drive
  std::string reason;                  ///< why joined or not
  double stamp_offset_s = 0.0;         ///< was added to the log's stamps
  std::vector<std::string> floors;     ///< labels, in order of first visit
};
/// One for each drive.
std::vector<DriveFacts> FactsOfDrives(const BuildingMap& map);

/// The map's warnings, and one for each piece that stays apart.
std::vector<std::string> WarningsOf(const BuildingMap& map);

}  // namespace masked_mapper
