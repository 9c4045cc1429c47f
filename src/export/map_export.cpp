// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <chrono>
#include <cstdint>
#include <future>
#include <string>
#include <utility>

#include "masked_mapper/export/closures_file.hpp"
#include "masked_mapper/export/floor_label.hpp"
#include "masked_mapper/export/g2o_file.hpp"
#include "masked_mapper/export/occupancy_grid_file.hpp"
#include "masked_mapper/export/octomap_file.hpp"
#include "masked_mapper/export/point_cloud_file.hpp"
#include "masked_mapper/export/report.hpp"
#include "masked_mapper/export/trajectory_file.hpp"
#include "masked_mapper/rendering/point_cloud.hpp"

namespace masked_mapper {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void WriteOctree(const PoseGraph& graph, const std::vector<OccupancyGrid>& grids,
                 const OctreeOptions& options, const std::filesystem::path& path) {
  std::vector<FloorLayer> layers;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    layers.push_back({&grids[i], graph.floors()[i].elevation});
  }
  WriteOctomap(*BuildOctree(layers, options), path);
}

void WriteFloors(const PoseGraph& graph, const std::vector<OccupancyGrid>& grids,
                 const std::filesystem::path& folder) {
  const std::vector<Colour> colours = FloorColours(graph.floors());
  ColouredCloud building;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const Floor& floor = graph.floors()[i];
    const ColouredCloud cloud =
        Coloured(WallCloud(grids[i], floor.elevation, static_cast<std::uint32_t>(i)), colours);
    const std::string stem = (folder / "floors" / floor.label).string();
    WritePcd(cloud, stem + ".pcd");
    WriteOccupancyGrid(grids[i], stem);
    WriteG2o(graph, static_cast<FloorId>(i), stem + ".g2o");
    building += cloud;
  }
  WritePcd(building, folder / "building.pcd");
  WritePly(building, folder / "building.ply");
}

// Each drive with the stamps of its own log, so that it can be held against a truth of its own.
void WriteDrives(const MappingResult& result, const std::filesystem::path& folder) {
  if (result.drives.size() < 2) return;
  std::filesystem::create_directory(folder / "drives");
  for (std::size_t i = 0; i < result.drives.size(); ++i) {
    const IndexRange poses = PosesOfDrive(result, i);
    std::vector<TrajectoryPose> own(
        result.trajectory.begin() + static_cast<std::ptrdiff_t>(poses.begin),
        result.trajectory.begin() + static_cast<std::ptrdiff_t>(poses.end));
    for (TrajectoryPose& pose : own) pose.stamp -= result.drives[i].stamp_offset_s;
    WriteTrajectory(own, result.graph.floors(),
                    folder / "drives" / (std::to_string(i + 1) + ".tum"));
  }
}

}  // namespace

std::vector<FloorGrid> RenderGrids(const MappingResult& result, const GridOptions& options,
                                   const std::optional<FloorId>& floor) {
  std::vector<PosedScan> scans;
  scans.reserve(result.kept_scans.size());
  for (const KeptScan& kept : result.kept_scans) {
    const TrajectoryPose& pose = result.trajectory.at(kept.trajectory_index);
    if (!pose.in_transit) scans.push_back({pose.T_world_robot, pose.floor, &kept.scan});
  }
  std::vector<FloorGrid> grids;
  for (std::size_t i = 0; i < result.graph.floors().size(); ++i) {
    const auto id = static_cast<FloorId>(i);
    if (!floor || *floor == id) grids.push_back({id, RenderGrid(scans, id, options)});
  }
  return grids;
}

std::vector<OccupancyGrid> RenderFloors(const MappingResult& result, const GridOptions& options) {
  std::vector<OccupancyGrid> grids;
  for (FloorGrid& grid : RenderGrids(result, options, {})) grids.push_back(std::move(grid.grid));
  return grids;
}

Summary WriteMap(const MappingResult& result, const RunDescription& run,
                 const ExportOptions& options, const std::filesystem::path& folder) {
  CheckFloorLabels(result.graph.floors());
  const auto rendering_start = Clock::now();
  const std::vector<OccupancyGrid> grids = RenderFloors(result, options.grid);
  const double rendering_seconds = SecondsSince(rendering_start);

  const auto export_start = Clock::now();
  std::filesystem::create_directory(folder / "floors");
  // The octree takes about as long as all the rest.
  auto octree =
      std::async(options.grid.threads > 1 ? std::launch::async : std::launch::deferred,
                 [&] { WriteOctree(result.graph, grids, options.octree, folder / "building.bt"); });
  WriteFloors(result.graph, grids, folder);
  WriteTrajectory(result.trajectory, result.graph.floors(), folder / "trajectory.tum");
  WriteDrives(result, folder);
  WriteNodes(result.graph, folder / "nodes.tum");
  WriteG2o(result.graph, folder / "graph.g2o");
  WriteClosures(result.attempts, result.graph, folder / "closures.csv");
  const std::string report = ReportData(result, grids, options.grid.max_usable_range_m);
  octree.get();

  Summary summary = Summarise(result, run, grids);
  summary.seconds.rendering += rendering_seconds;
  summary.seconds.export_ += SecondsSince(export_start);
  summary.seconds.total += SecondsSince(rendering_start);
  WriteSummary(summary, folder / "summary.json");
  WriteReport(report, summary, folder / "report.html");
  return summary;
}

}  // namespace masked_mapper
