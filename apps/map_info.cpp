// SPDX-License-Identifier: BSD-3-Clause
#include "map_info.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "run_description.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

struct MapFacts {
  std::filesystem::path file;
  std::uintmax_t bytes = 0;
  Summary summary;
  double duration_s = 0.0;
  double path_length_m = 0.0;  ///< along the optimised trajectory, floors by their plan alone
  std::uint64_t kept_scans = 0;
  std::uint64_t kept_clouds = 0;
  std::uint64_t cloud_bytes = 0;
  std::vector<std::pair<std::string, std::uint64_t>> edges;   ///< by kind
  std::vector<std::pair<std::string, std::uint64_t>> states;  ///< of attempts
  NamedValues changed;                                        ///< options that are not the default
};

MapFacts FactsOf(const std::string& out_or_map) {
  MapFacts facts;
  facts.file = MapFileOf(out_or_map);
  const SavedMap map = ReadMapFile(facts.file);
  facts.bytes = std::filesystem::file_size(facts.file);
  const BuildingMap& result = map.result;
  facts.summary = Summarise(result, DescriptionOf(map.origin, result),
                            RenderFloors(result, map.origin.options.grid));
  const std::vector<TrajectoryPose>& trajectory = result.trajectory;
  if (!trajectory.empty()) facts.duration_s = trajectory.back().stamp - trajectory.front().stamp;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    if (DriveOfPose(result, i - 1) != DriveOfPose(result, i)) continue;
    facts.path_length_m += Distance(trajectory[i - 1].T_world_robot, trajectory[i].T_world_robot);
  }
  facts.kept_scans = result.kept_scans.size();
  facts.kept_clouds = result.kept_clouds.size();
  for (const KeptCloud& kept : result.kept_clouds) facts.cloud_bytes += kept.packed->size();
  for (const char* kind : NamesOf(EdgeKind{})) facts.edges.emplace_back(kind, 0);
  for (const Edge& edge : result.graph.edges()) {
    ++facts.edges[static_cast<std::size_t>(edge.kind)].second;
  }
  for (const auto state : {ClosureState::kRejectedScore, ClosureState::kHypothesis,
                           ClosureState::kValidated, ClosureState::kAuditedOut}) {
    facts.states.emplace_back(Name(state), 0);
  }
  for (const Closure& closure : result.closures) {
    ++facts.states[static_cast<std::size_t>(closure.state)].second;
  }
  facts.changed = ChangedOptions(map.origin.options);
  std::vector<std::string>& warnings = facts.summary.warnings;
  warnings.insert(warnings.end(), map.left_aside.begin(), map.left_aside.end());
  return facts;
}

void PrintText(const MapFacts& facts) {
  const auto line = [](const std::string& name, const std::string& value) {
    std::cout << "  " << name << std::string(name.size() < 14 ? 14 - name.size() : 1, ' ') << value
              << "\n";
  };
  const Summary& summary = facts.summary;
  std::cout << facts.file.string() << "\n";
  line("made from", summary.run.log);
  line("mask", summary.run.mask);
  line("motion by", summary.motion_source);
  line("duration", FixedText(facts.duration_s, 1) + " s");
  line("path", FixedText(facts.path_length_m, 1) + " m, " + std::to_string(summary.counts.scans) +
                   " scans, " + std::to_string(facts.kept_scans) + " of them kept");
  if (facts.kept_clouds > 0) {
    line("clouds", std::to_string(facts.kept_clouds) + " kept, " +
                       FixedText(static_cast<double>(facts.cloud_bytes) / (1 << 20), 1) + " MiB");
  }
  line("nodes", std::to_string(summary.counts.nodes) + ", " +
                    std::to_string(summary.counts.scan_nodes) + " with a scan");
  std::string edges;
  for (const auto& [kind, count] : facts.edges) {
    edges += (edges.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  }
  line("edges", edges);
  std::string attempts = std::to_string(summary.counts.attempted) + " pairs tried";
  for (const auto& [state, count] : facts.states) {
    attempts += ", " + std::to_string(count) + " " + state;
  }
  line("closures", attempts);
  for (const Summary::FloorEntry& floor : summary.floors) {
    line("floor " + floor.label, "at " + FixedText(floor.elevation_m, 2) + " m" +
                                     (floor.elevation_measured ? "" : " (assumed)") + ", " +
                                     std::to_string(floor.nodes) + " nodes, " +
                                     FixedText(floor.area_m2, 1) + " m2 known");
  }
  for (std::size_t i = 0; i < summary.drives.size(); ++i) {
    const DriveFacts& drive = summary.drives[i];
    line("drive " + std::to_string(i + 1),
         drive.log + ": " + std::to_string(drive.scans) + " scans, " +
             (drive.joined ? "" : "a piece of its own, ") +
             std::to_string(drive.closures_to_others) + " closures to other drives" +
             (drive.reason.empty() ? "" : "; " + drive.reason));
  }
  for (const auto& [key, value] : facts.changed) line("option", key + " = " + value);
  line("file", FixedText(static_cast<double>(facts.bytes) / (1 << 20), 1) + " MiB");
  for (const std::string& warning : summary.warnings) line("warning", warning);
}

void PrintJson(const MapFacts& facts) {
  const Summary& summary = facts.summary;
  Json floors = Json::array();
  for (const Summary::FloorEntry& floor : summary.floors) {
    floors.push_back({{"label", floor.label},
                      {"elevation_m", floor.elevation_m},
                      {"elevation_measured", floor.elevation_measured},
                      {"nodes", floor.nodes},
                      {"area_m2", floor.area_m2}});
  }
  Json edges = Json::object();
  for (const auto& [kind, count] : facts.edges) edges[kind] = count;
  Json states = Json::object();
  for (const auto& [state, count] : facts.states) states[state] = count;
  Json changed = Json::object();
  for (const auto& [key, value] : facts.changed) changed[key] = value;
  Json json = {{"map", facts.file.string()},
               {"bytes", facts.bytes},
               {"log", summary.run.log},
               {"mask", summary.run.mask},
               {"motion_source", summary.motion_source},
               {"duration_s", facts.duration_s},
               {"path_length_m", facts.path_length_m},
               {"counts",
                {{"observations", summary.counts.observations},
                 {"scans", summary.counts.scans},
                 {"kept_scans", facts.kept_scans},
                 {"kept_clouds", facts.kept_clouds},
                 {"nodes", summary.counts.nodes},
                 {"scan_nodes", summary.counts.scan_nodes},
                 {"odometry_nodes", summary.counts.odometry_nodes},
                 {"attempted", summary.counts.attempted},
                 {"matched", summary.counts.matched},
                 {"validated", summary.counts.validated}}},
               {"edges", edges},
               {"closures", states},
               {"floors", floors},
               {"changed_options", changed},
               {"warnings", summary.warnings}};
  if (!summary.drives.empty()) {
    json["drives"] = Json::parse(SummaryText(summary), nullptr, false).at("drives");
  }
  // A path may hold bytes that are no UTF-8.
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

}  // namespace

void PrintMapInfo(const std::string& out_or_map, bool as_json) {
  (as_json ? PrintJson : PrintText)(FactsOf(out_or_map));
}

}  // namespace masked_mapper
