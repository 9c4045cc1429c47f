// SPDX-License-Identifier: BSD-3-Clause
// What a run did and made, in numbers: for summary.json and the closing table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "masked_mapper/doubt/doubt.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// An option in force: its key and its value.
using SettingValue = std::variant<bool, std::int64_t, double, std::string>;
using Setting = std::pair<std::string, SettingValue>;

/// What the run was asked to do.
struct RunDescription {
  std::string log;   ///< path as given
  std::string mask;  ///< as given, e.g. "any(openings,eccentricity)"
  std::vector<Setting> settings;
};

struct Summary {
  struct Counts {
    std::uint64_t observations = 0;
    std::uint64_t scans = 0;
    std::uint64_t nodes = 0;
    std::uint64_t scan_nodes = 0;
    std::uint64_t odometry_nodes = 0;
    std::uint64_t attempted = 0;  ///< pairs offered to the matcher
    std::uint64_t matched = 0;    ///< of these, matches above MinScore
    std::uint64_t validated = 0;  ///< of these, closures in the final graph
  };
  struct FloorEntry {
    std::string label;
    double elevation_m = 0.0;
    bool elevation_measured = false;
    std::uint64_t nodes = 0;
    double area_m2 = 0.0;              ///< known to be free or occupied
    std::uint64_t parallel_parts = 0;  ///< whose heading walls tell
  };

  struct TransitEntry {
    TransitRecord transit;
    std::string from;  ///< label of a floor
    std::string to;
  };

  RunDescription run;
  std::string motion_source;  ///< the one that was used: odometry, scans or fused
  Counts counts;
  std::vector<FloorEntry> floors;  ///< by FloorId, which is the field `label` of the clouds
  std::vector<TransitEntry> transits;
  /// Attempts that did not become closures, by reason; most frequent first.
  std::vector<std::pair<std::string, std::uint64_t>> rejections;
  StageSeconds seconds;
  double peak_memory_mib = 0.0;
  std::vector<std::string> warnings;
  std::vector<Doubt> doubts;  ///< empty: the map holds together
  std::vector<SensorFinding> findings;
  /// Place in the trajectory and stamp of the scans whose stamp is not their log's own, but for the
  /// shift of their drive: the motion, nodes and closures go by it.
  std::vector<std::pair<std::uint64_t, double>> mended_stamps;
  std::vector<DriveFacts> drives;  ///< of a map of several logs; else none
};

/// `grids` by FloorId. Seconds are the result's, their total the
/// sum of the stages unless the result has one; the peak of memory is that of the process up to
/// now.
Summary Summarise(const BuildingMap& result, const RunDescription& run,
                  const std::vector<OccupancyGrid>& grids);

/// As JSON, in a fixed order of keys.
std::string SummaryText(const Summary& summary);

/// SummaryText as a file. Throws std::runtime_error when it cannot be written.
void WriteSummary(const Summary& summary, const std::filesystem::path& path);

/// The summary as lines for people: nodes, closures and why others were rejected, floors, seconds
/// per stage and memory.
std::string ClosingTable(const Summary& summary);

}  // namespace masked_mapper
