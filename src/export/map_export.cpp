// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "closures_file.hpp"
#include "floor_label.hpp"
#include "g2o_file.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "occupancy_grid_file.hpp"
#include "octomap_file.hpp"
#include "point_cloud_file.hpp"
#include "report.hpp"
#include "trajectory_file.hpp"
#include "wall_cloud.hpp"

namespace masked_mapper {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<PosedScan> DrawnScans(const BuildingMap& result) {
  std::vector<PosedScan> scans;
  scans.reserve(result.kept_scans.size());
  std::size_t drive = 0;
  for (const KeptScan& kept : result.kept_scans) {
    const TrajectoryPose& pose = result.trajectory.at(kept.trajectory_index);
    while (drive + 1 < result.drives.size() &&
           kept.trajectory_index >= result.drives[drive + 1].first_pose) {
      ++drive;
    }
    if (!pose.in_transit) scans.push_back({pose.T_world_robot, pose.floor, &kept.scan, drive});
  }
  return scans;
}

/// With what people drew into it.
OccupancyGrid DrawFloor(const BuildingMap& result, const std::vector<PosedScan>& scans,
                        FloorId floor, const GridOptions& options) {
  OccupancyGrid grid = RenderGrid(scans, floor, options);
  for (const Area& area : result.areas) {
    if (area.floor == floor && area.kind == AreaKind::kErased) {
      EraseWalls(area.corners_in_world, grid);
    }
  }
  for (const Area& area : result.areas) {
    if (area.floor == floor && area.kind == AreaKind::kKeepOut) {
      ForgetFree(area.corners_in_world, grid);
    }
  }
  return grid;
}

using Names = std::vector<std::string>;

/// What could not be written, and why.
class Unwritten {
 public:
  bool empty() const { return files_.empty(); }
  bool is_too_large() const { return is_too_large_; }

  void Add(const Names& files, const std::string& reason, bool too_large) {
    if (files_.empty()) reason_ = reason;
    files_.insert(files_.end(), files.begin(), files.end());
    is_too_large_ = is_too_large_ || too_large;
  }
  void Add(const Unwritten& others) {
    if (!others.empty()) Add(others.files_, others.reason_, others.is_too_large_);
  }

  /// One line: the reason is that of the first.
  std::string Text() const {
    constexpr std::size_t kNamed = 8;
    std::string names;
    for (std::size_t i = 0; i < std::min(files_.size(), kNamed); ++i) {
      names += (i == 0 ? "" : ", ") + files_[i];
    }
    if (files_.size() > kNamed) {
      names += " and " + std::to_string(files_.size() - kNamed) + " more files";
    }
    return names + " could not be written: " + reason_;
  }

 private:
  Names files_;
  std::string reason_;
  bool is_too_large_ = false;
};

/// Writes the files of a map, whatever becomes of each.
class MapWriter {
 public:
  MapWriter(const BuildingMap& result, const ExportOptions& options,
            const std::filesystem::path& folder)
      : result_(result), options_(options), folder_(folder) {}

  void Render() {
    const std::vector<PosedScan> scans = DrawnScans(result_);
    for (std::size_t i = 0; i < floors().size(); ++i) {
      OccupancyGrid grid;
      grid.resolution_m = options_.grid.resolution_m;
      const std::string stem = "floors/" + floors()[i].label;
      const bool is_drawn = Try({stem + ".pcd", stem + ".pgm", stem + ".yaml"}, unwritten_, [&] {
        grid = DrawFloor(result_, scans, static_cast<FloorId>(i), options_.grid);
      });
      is_drawn_.push_back(is_drawn);
      grids_.push_back(std::move(grid));
    }
  }

  /// All but the summary and the report, for which they are worked out.
  void WriteFiles(const RunDescription& run, Summary& summary, std::string& report) {
    // A building without one of its floors would pass for the whole.
    const bool is_whole = std::count(is_drawn_.begin(), is_drawn_.end(), false) == 0;
    if (!is_whole) unwritten_.Add({"building.bt", "building.pcd", "building.ply"}, "", true);
    // What takes longest comes first.
    const std::vector<std::function<void(Unwritten&)>> parts = {
        [&](Unwritten& /*unwritten*/) { summary = Summarise(result_, run, grids_); },
        [&](Unwritten& unwritten) {
          if (is_whole) Try({"building.bt"}, unwritten, [&] { WriteOctree(); });
        },
        [&](Unwritten& unwritten) { WriteClouds(is_whole, unwritten); },
        [&](Unwritten& unwritten) {
          Try({"report.html"}, unwritten,
              [&] { report = ReportData(result_, grids_, options_.grid.max_usable_range_m); });
        },
        [&](Unwritten& unwritten) { WriteTables(unwritten); }};
    std::vector<Unwritten> unwritten(parts.size());
    ForEach(parts.size(), options_.grid.threads, [&](std::size_t i) { parts[i](unwritten[i]); });
    for (const Unwritten& of_part : unwritten) unwritten_.Add(of_part);
  }

  void WriteSummaryAndReport(Summary& summary, const std::string& report) {
    if (!unwritten_.empty()) summary.warnings.push_back(unwritten_.Text());
    Write("summary.json", unwritten_, [&](const auto& path) { WriteSummary(summary, path); });
    if (report.empty()) return;
    Write("report.html", unwritten_, [&](const auto& path) { WriteReport(report, summary, path); });
  }

  const Unwritten& unwritten() const { return unwritten_; }

 private:
  const std::vector<Floor>& floors() const { return result_.graph.floors(); }

  /// Whether it was done; if not, the files are removed and noted.
  bool Try(const Names& files, Unwritten& unwritten, const std::function<void()>& write) const {
    std::string reason;
    bool too_large = false;
    try {
      write();
      return true;
    } catch (const InputError& error) {
      reason = error.what();
      too_large = true;
    } catch (const std::bad_alloc&) {
      reason = "out of memory";
    } catch (const std::exception& error) {
      reason = error.what();
    }
    unwritten.Add(files, reason, too_large);
    std::error_code ignored;
    for (const std::string& file : files) std::filesystem::remove(folder_ / file, ignored);
    return false;
  }

  void Write(const std::string& file, Unwritten& unwritten,
             const std::function<void(const std::filesystem::path&)>& write) const {
    Try({file}, unwritten, [&] { write(folder_ / file); });
  }

  void WriteOctree() const {
    std::vector<FloorLayer> layers;
    for (std::size_t i = 0; i < grids_.size(); ++i) {
      layers.push_back({&grids_[i], floors()[i].elevation});
    }
    WriteOctomap(BuildOctree(layers, options_.octree), folder_ / "building.bt");
  }

  void WriteClouds(bool is_whole, Unwritten& unwritten) const {
    const ColouredCloud building = WriteFloors(unwritten);
    if (!is_whole) return;
    Write("building.pcd", unwritten, [&](const auto& path) { WritePcd(building, path); });
    Write("building.ply", unwritten, [&](const auto& path) { WritePly(building, path); });
  }

  /// And gives their walls, all together.
  ColouredCloud WriteFloors(Unwritten& unwritten) const {
    const std::vector<Colour> colours = FloorColours(floors());
    ColouredCloud building;
    for (std::size_t i = 0; i < grids_.size(); ++i) {
      const Floor& floor = floors()[i];
      const std::string stem = "floors/" + floor.label;
      Write(stem + ".g2o", unwritten,
            [&](const auto& path) { WriteG2o(result_.graph, static_cast<FloorId>(i), path); });
      if (!is_drawn_[i]) continue;
      const ColouredCloud cloud =
          Coloured(WallCloud(grids_[i], floor.elevation, static_cast<std::uint32_t>(i)), colours);
      Write(stem + ".pcd", unwritten, [&](const auto& path) { WritePcd(cloud, path); });
      Try({stem + ".pgm", stem + ".yaml"}, unwritten,
          [&] { WriteOccupancyGrid(grids_[i], (folder_ / stem).string()); });
      building += cloud;
    }
    return building;
  }

  void WriteTables(Unwritten& unwritten) const {
    const PoseGraph& graph = result_.graph;
    Write("trajectory.tum", unwritten,
          [&](const auto& path) { WriteTrajectory(result_.trajectory, graph.floors(), path); });
    WriteDrives(unwritten);
    Write("nodes.tum", unwritten, [&](const auto& path) { WriteNodes(graph, path); });
    Write("graph.g2o", unwritten, [&](const auto& path) { WriteG2o(graph, path); });
    Write("closures.csv", unwritten,
          [&](const auto& path) { WriteClosures(result_.closures, graph, path); });
  }

  // Each drive by itself, so that it can be held against a truth of its own.
  void WriteDrives(Unwritten& unwritten) const {
    if (result_.drives.size() < 2) return;
    std::filesystem::create_directory(folder_ / "drives");
    for (std::size_t i = 0; i < result_.drives.size(); ++i) {
      const IndexRange poses = PosesOfDrive(result_, i);
      const std::vector<TrajectoryPose> own(
          result_.trajectory.begin() + static_cast<std::ptrdiff_t>(poses.begin),
          result_.trajectory.begin() + static_cast<std::ptrdiff_t>(poses.end));
      Write("drives/" + std::to_string(i + 1) + ".tum", unwritten,
            [&](const auto& path) { WriteTrajectory(own, floors(), path); });
    }
  }

  const BuildingMap& result_;
  const ExportOptions& options_;
  const std::filesystem::path& folder_;
  std::vector<OccupancyGrid> grids_;  // by FloorId; empty where it could not be drawn
  std::vector<bool> is_drawn_;
  Unwritten unwritten_;
};

}  // namespace

std::vector<FloorGrid> RenderGrids(const BuildingMap& result, const GridOptions& options,
                                   const std::optional<FloorId>& floor) {
  const std::vector<PosedScan> scans = DrawnScans(result);
  std::vector<FloorGrid> grids;
  for (std::size_t i = 0; i < result.graph.floors().size(); ++i) {
    const auto id = static_cast<FloorId>(i);
    if (!floor || *floor == id) grids.push_back({id, DrawFloor(result, scans, id, options)});
  }
  return grids;
}

std::vector<OccupancyGrid> RenderFloors(const BuildingMap& result, const GridOptions& options) {
  std::vector<OccupancyGrid> grids;
  for (FloorGrid& grid : RenderGrids(result, options, {})) grids.push_back(std::move(grid.grid));
  return grids;
}

std::vector<std::filesystem::path> ExportedFiles(const BuildingMap& result) {
  std::vector<std::filesystem::path> files = {"building.bt",  "building.pcd",   "building.ply",
                                              "graph.g2o",    "trajectory.tum", "nodes.tum",
                                              "closures.csv", "summary.json",   "report.html"};
  for (const Floor& floor : result.graph.floors()) {
    for (const char* ending : {".pcd", ".pgm", ".yaml", ".g2o"}) {
      files.push_back(std::filesystem::path("floors") / (floor.label + ending));
    }
  }
  for (std::size_t i = 0; result.drives.size() > 1 && i < result.drives.size(); ++i) {
    files.push_back(std::filesystem::path("drives") / (std::to_string(i + 1) + ".tum"));
  }
  return files;
}

Summary WriteMap(const BuildingMap& result, const RunDescription& run, const ExportOptions& options,
                 const std::filesystem::path& folder) {
  CheckFloorLabels(result.graph.floors());
  MapWriter writer(result, options, folder);
  const auto rendering_start = Clock::now();
  writer.Render();
  const double rendering_seconds = SecondsSince(rendering_start);

  const auto export_start = Clock::now();
  std::filesystem::create_directory(folder / "floors");
  Summary summary;
  std::string report;
  writer.WriteFiles(run, summary, report);
  summary.seconds.rendering += rendering_seconds;
  summary.seconds.export_ += SecondsSince(export_start);
  summary.seconds.total += SecondsSince(rendering_start);
  writer.WriteSummaryAndReport(summary, report);
  const Unwritten& unwritten = writer.unwritten();
  if (!unwritten.empty()) throw ExportError(unwritten.Text(), unwritten.is_too_large());
  return summary;
}

}  // namespace masked_mapper
