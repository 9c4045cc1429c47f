// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/localization_export.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "localization_page.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"
#include "trajectory_file.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

std::string Dumped(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::size_t PlacedOf(const Localization& drive) {
  return static_cast<std::size_t>(std::count_if(
      drive.scans.begin(), drive.scans.end(), [](const LocatedScan& scan) { return scan.placed; }));
}

/// Labels in order of the first visit.
Json FloorsOf(const BuildingMap& map, const Localization& drive) {
  std::vector<FloorId> floors;
  for (const LocatedScan& scan : drive.scans) {
    if (scan.placed && std::find(floors.begin(), floors.end(), scan.floor) == floors.end()) {
      floors.push_back(scan.floor);
    }
  }
  Json labels = Json::array();
  for (const FloorId floor : floors) labels.push_back(map.graph.floor(floor).label);
  return labels;
}

std::string Words(const Localization& drive, const LocalizationRun& run) {
  if (!drive.found) return "Not found: " + run.doubt + ".";
  return "Found after " + FixedText(drive.found_after_m, 1) + " m of driving; " +
         std::to_string(PlacedOf(drive)) + " of " + std::to_string(drive.scans.size()) +
         " scans placed, " + std::to_string(drive.matches) + " matched.";
}

}  // namespace

std::string LocalizationSummaryText(const BuildingMap& map, const Localization& drive,
                                    const std::vector<MapChange>& changes,
                                    const LocalizationRun& run) {
  Json json;
  json["found"] = drive.found;
  json["found_after_m"] = drive.found ? Json(drive.found_after_m) : Json(nullptr);
  json["scans"] = drive.scans.size();
  json["placed"] = PlacedOf(drive);
  json["floors"] = FloorsOf(map, drive);
  json["matches"] = drive.matches;
  json["searches"] = drive.searches;
  json["unsure_spans"] = Json::array();
  for (const UnsureSpan& span : drive.unsure_spans) {
    json["unsure_spans"].push_back({{"t_a", span.t_a}, {"t_b", span.t_b}, {"why", span.why}});
  }
  json["changes"] = Json::array();
  for (const MapChange& change : changes) {
    json["changes"].push_back({{"kind", Name(change.kind)},
                               {"floor", map.graph.floor(change.floor).label},
                               {"x", change.x},
                               {"y", change.y},
                               {"size_m", change.size_m}});
  }
  json["doubt"] = run.doubt.empty() ? Json(nullptr) : Json(run.doubt);
  json["logs"] = run.logs;
  json["map"] = run.map;
  json["warnings"] = run.warnings;
  json["seconds"] = run.seconds;
  return Dumped(json, 2) + "\n";
}

std::string PoseLine(const BuildingMap& map, const LocatedScan& scan) {
  Json json = {{"t", scan.log_stamp}};
  const auto known = [&](double value) { return scan.placed ? Json(value) : Json(nullptr); };
  const Pose2& pose = scan.T_world_robot.mean;
  const Eigen::Matrix3d& covariance = scan.T_world_robot.covariance;
  json["floor"] = scan.placed ? Json(map.graph.floor(scan.floor).label) : Json(nullptr);
  json["x"] = known(pose.x);
  json["y"] = known(pose.y);
  json["theta"] = known(pose.theta);
  json["sigma_x"] = known(std::sqrt(covariance(0, 0)));
  json["sigma_y"] = known(std::sqrt(covariance(1, 1)));
  json["sigma_theta"] = known(std::sqrt(covariance(2, 2)));
  json["sure"] = scan.sure;
  return Dumped(json, -1);
}

void WriteLocalization(const BuildingMap& map, const Localization& drive,
                       const std::vector<MapChange>& changes, const LocalizationRun& run,
                       const std::filesystem::path& folder) {
  std::string trajectory;
  std::string floors = "t,label\n";
  for (const LocatedScan& scan : drive.scans) {
    const Floor& floor = map.graph.floor(scan.floor);
    if (scan.placed) {
      trajectory += TumLine(scan.log_stamp, scan.T_world_robot.mean, floor.elevation);
    }
    floors += ExactText(scan.log_stamp) + "," + (scan.sure ? floor.label : "?") + "\n";
  }
  WriteFile(folder / "trajectory.tum", trajectory);
  WriteFile(folder / "floors.csv", floors);
  WriteFile(folder / "summary.json", LocalizationSummaryText(map, drive, changes, run));
  WriteFile(folder / "page.html", LocalizationPage(map, drive, changes, Words(drive, run)));
}

}  // namespace masked_mapper
