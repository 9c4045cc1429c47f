// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/summary_file.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "masked_mapper/text/enum_names.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

double PeakMemoryMib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in KiB
}

// JSON has no word for what is not finite.
double Rounded(double value, double per_unit) {
  return std::isfinite(value) ? std::round(value * per_unit) / per_unit : 0.0;
}

std::vector<std::pair<std::string, std::uint64_t>> RejectionsOf(
    const std::vector<Closure>& closures) {
  std::map<std::string, std::uint64_t> by_reason;
  for (const Closure& closure : closures) {
    if (closure.state != ClosureState::kValidated) ++by_reason[Name(closure.reason)];
  }
  std::vector<std::pair<std::string, std::uint64_t>> sorted(by_reason.begin(), by_reason.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

Summary::Counts CountsOf(const BuildingMap& result) {
  const auto closures_with = [&result](const auto& condition) {
    return static_cast<std::uint64_t>(
        std::count_if(result.closures.begin(), result.closures.end(),
                      [&](const Closure& closure) { return condition(closure.state); }));
  };
  const LogStatistics& log = result.log;
  Summary::Counts counts;
  counts.observations =
      log.scans + log.odometry + log.pressure + log.acceleration + log.floor_labels;
  counts.scans = result.trajectory.size();
  counts.nodes = result.graph.nodes().size();
  counts.scan_nodes = static_cast<std::uint64_t>(
      std::count_if(result.graph.nodes().begin(), result.graph.nodes().end(),
                    [](const Node& node) { return node.HasScan(); }));
  counts.odometry_nodes = counts.nodes - counts.scan_nodes;
  counts.attempted = result.closures.size();
  counts.matched =
      closures_with([](ClosureState state) { return state != ClosureState::kRejectedScore; });
  counts.validated =
      closures_with([](ClosureState state) { return state == ClosureState::kValidated; });
  return counts;
}

// The stages follow each other, so that they add up to the whole.
StageSeconds WithTotal(StageSeconds seconds) {
  if (seconds.total > 0.0) return seconds;
  seconds.total = seconds.read + seconds.motion + seconds.mask + seconds.projection +
                  seconds.matching + seconds.validation + seconds.optimisation + seconds.rendering +
                  seconds.export_;
  return seconds;
}

Json CountsJson(const Summary::Counts& counts) {
  return {{"observations", counts.observations},
          {"scans", counts.scans},
          {"nodes", counts.nodes},
          {"scan_nodes", counts.scan_nodes},
          {"odometry_nodes", counts.odometry_nodes},
          {"attempted", counts.attempted},
          {"matched", counts.matched},
          {"validated", counts.validated}};
}

Json FloorsJson(const std::vector<Summary::FloorEntry>& floors) {
  Json json = Json::array();
  for (const Summary::FloorEntry& floor : floors) {
    json.push_back({{"label", floor.label},
                    {"elevation_m", Rounded(floor.elevation_m, 1000.0)},
                    {"elevation_measured", floor.elevation_measured},
                    {"nodes", floor.nodes},
                    {"area_m2", Rounded(floor.area_m2, 100.0)},
                    {"parallel_parts", floor.parallel_parts}});
  }
  return json;
}

/// With the floors of the last pose before and of the first one after.
std::vector<Summary::TransitEntry> TransitsOf(const BuildingMap& result) {
  std::vector<Summary::TransitEntry> entries;
  if (result.trajectory.empty()) return entries;
  const auto label_at = [&](double stamp, bool before) {
    auto pose = std::lower_bound(
        result.trajectory.begin(), result.trajectory.end(), stamp,
        [](const TrajectoryPose& known, double value) { return known.stamp < value; });
    if (pose != result.trajectory.begin() && (before || pose == result.trajectory.end())) --pose;
    return result.graph.floors()[static_cast<std::size_t>(pose->floor)].label;
  };
  for (const TransitRecord& transit : result.transits) {
    entries.push_back({transit, label_at(transit.t_out, true), label_at(transit.t_in, false)});
  }
  return entries;
}

Json TransitsJson(const std::vector<Summary::TransitEntry>& entries) {
  Json json = Json::array();
  for (const Summary::TransitEntry& entry : entries) {
    const TransitRecord& transit = entry.transit;
    json.push_back({{"t_out", Rounded(transit.t_out, 1000.0)},
                    {"t_in", Rounded(transit.t_in, 1000.0)},
                    {"from", entry.from},
                    {"to", entry.to},
                    {"height_m", Rounded(transit.height_m, 1000.0)},
                    {"sigma_m", Rounded(transit.sigma_m, 1000.0)},
                    {"by", transit.by}});
  }
  return json;
}

Json DrivesJson(const std::vector<DriveFacts>& drives) {
  Json json = Json::array();
  for (const DriveFacts& drive : drives) {
    json.push_back({{"log", drive.log},
                    {"joined", drive.joined},
                    {"piece", drive.piece},
                    {"scans", drive.scans},
                    {"nodes", drive.nodes},
                    {"closures_to_others", drive.closures_to_others},
                    {"stamp_offset_s", drive.stamp_offset_s},
                    {"floors", drive.floors},
                    {"reason", drive.reason}});
  }
  return json;
}

Json DoubtsJson(const std::vector<Doubt>& doubts, const std::vector<Summary::FloorEntry>& floors) {
  Json json = Json::array();
  for (const Doubt& doubt : doubts) {
    json.push_back({{"kind", Name(doubt.kind)},
                    {"floor", floors.at(static_cast<std::size_t>(doubt.floor)).label},
                    {"x", Rounded(doubt.x, 1000.0)},
                    {"y", Rounded(doubt.y, 1000.0)},
                    {"t_a", doubt.t_a},
                    {"t_b", doubt.t_b},
                    {"size_m", Rounded(doubt.size_m, 1000.0)},
                    {"text", doubt.text}});
    if (!doubt.edit.empty()) json.back()["edit"] = doubt.edit;
  }
  return json;
}

Json FindingsJson(const std::vector<SensorFinding>& findings) {
  Json json = Json::array();
  for (const SensorFinding& finding : findings) {
    json.push_back({{"what", finding.what},
                    {"value", finding.value},
                    {"sigma", finding.sigma},
                    {"t_a", finding.t_a},
                    {"t_b", finding.t_b},
                    {"consequence", finding.consequence}});
  }
  return json;
}

std::vector<std::pair<std::uint64_t, double>> MendedStamps(const BuildingMap& result) {
  constexpr double kSameStamp = 1e-6;  // s
  std::vector<std::pair<std::uint64_t, double>> mended;
  for (std::size_t drive = 0; drive < result.drives.size(); ++drive) {
    const IndexRange poses = PosesOfDrive(result, drive);
    for (std::size_t i = poses.begin; i < poses.end; ++i) {
      const TrajectoryPose& pose = result.trajectory[i];
      const double shifted = pose.log_stamp + result.drives[drive].stamp_offset_s;
      if (std::abs(shifted - pose.stamp) > kSameStamp) mended.emplace_back(i, pose.stamp);
    }
  }
  return mended;
}

Json SecondsJson(const StageSeconds& seconds) {
  const auto rounded = [](double value) { return Rounded(value, 1e4); };
  return {{"read", rounded(seconds.read)},
          {"motion", rounded(seconds.motion)},
          {"mask", rounded(seconds.mask)},
          {"projection", rounded(seconds.projection)},
          {"matching", rounded(seconds.matching)},
          {"validation", rounded(seconds.validation)},
          {"optimisation", rounded(seconds.optimisation)},
          {"rendering", rounded(seconds.rendering)},
          {"export", rounded(seconds.export_)},
          {"total", rounded(seconds.total)}};
}

Json SettingsJson(const std::vector<Setting>& settings) {
  Json json = Json::object();
  for (const Setting& setting : settings) {
    const auto* number = std::get_if<double>(&setting.second);
    if (number != nullptr && !std::isfinite(*number)) {
      json[setting.first] = ExactText(*number);
      continue;
    }
    std::visit([&](const auto& value) { json[setting.first] = value; }, setting.second);
  }
  return json;
}

/// Parts of a floor whose heading walls tell.
std::uint64_t PartsTied(const PoseGraph& graph, FloorId floor) {
  const std::vector<Edge>& edges = graph.edges();
  return static_cast<std::uint64_t>(
      std::count_if(edges.begin(), edges.end(), [&](const Edge& edge) {
        return edge.kind == EdgeKind::kHeading && graph.node(edge.to).floor == floor;
      }));
}

}  // namespace

Summary Summarise(const BuildingMap& result, const RunDescription& run,
                  const std::vector<OccupancyGrid>& grids) {
  Summary summary;
  summary.run = run;
  summary.counts = CountsOf(result);
  const std::vector<Floor>& floors = result.graph.floors();
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const auto nodes = static_cast<std::uint64_t>(
        std::count_if(result.graph.nodes().begin(), result.graph.nodes().end(),
                      [i](const Node& node) { return static_cast<std::size_t>(node.floor) == i; }));
    summary.floors.push_back({floors[i].label, floors[i].elevation, floors[i].elevation_measured,
                              nodes, KnownArea(grids.at(i)),
                              PartsTied(result.graph, static_cast<FloorId>(i))});
  }
  summary.transits = TransitsOf(result);
  summary.rejections = RejectionsOf(result.closures);
  summary.motion_source = Name(result.motion_source);
  summary.seconds = WithTotal(result.seconds);
  summary.peak_memory_mib = PeakMemoryMib();
  summary.warnings = WarningsOf(result);
  summary.doubts = FindDoubts(result);
  summary.findings = result.findings;
  summary.mended_stamps = MendedStamps(result);
  if (result.drives.size() > 1) summary.drives = FactsOfDrives(result);
  return summary;
}

std::string SummaryText(const Summary& summary) {
  Json json = {{"log", summary.run.log},
               {"mask", summary.run.mask},
               {"motion_source", summary.motion_source},
               {"counts", CountsJson(summary.counts)},
               {"floors", FloorsJson(summary.floors)},
               {"transits", TransitsJson(summary.transits)},
               {"seconds", SecondsJson(summary.seconds)},
               {"peak_memory_mib", Rounded(summary.peak_memory_mib, 10.0)},
               {"options", SettingsJson(summary.run.settings)},
               {"doubts", DoubtsJson(summary.doubts, summary.floors)},
               {"warnings", summary.warnings},
               {"sensors", {{"findings", FindingsJson(summary.findings)}}}};
  if (!summary.mended_stamps.empty()) json["mended_stamps"] = summary.mended_stamps;
  if (!summary.drives.empty()) json["drives"] = DrivesJson(summary.drives);
  // A path may hold bytes that are no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void WriteSummary(const Summary& summary, const std::filesystem::path& path) {
  WriteFile(path, SummaryText(summary));
}

}  // namespace masked_mapper
