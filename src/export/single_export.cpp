// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include <algorithm>
#include <utility>

#include "floor_plan_file.hpp"
#include "g2o_file.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "occupancy_grid_file.hpp"
#include "octomap_file.hpp"
#include "output_file.hpp"
#include "point_cloud_file.hpp"
#include "trajectory_file.hpp"
#include "wall_cloud.hpp"

namespace masked_mapper {
namespace {

std::string Labels(const std::vector<Floor>& floors) {
  std::string labels;
  for (const Floor& floor : floors) labels += (labels.empty() ? "" : ", ") + floor.label;
  return labels;
}

bool HasHeights(ExportFormat format) {
  return format == ExportFormat::kOctomap || format == ExportFormat::kPcd ||
         format == ExportFormat::kPly;
}

void WriteClouds(const BuildingMap& result, const std::vector<FloorGrid>& grids,
                 const SingleExport& wanted, const std::filesystem::path& path) {
  const std::vector<Floor>& floors = result.graph.floors();
  const std::vector<Colour> colours = FloorColours(floors);
  ColouredCloud building;
  for (const FloorGrid& grid : grids) {
    const double elevation = floors[static_cast<std::size_t>(grid.floor)].elevation;
    if (elevation < wanted.heights.low_m || elevation > wanted.heights.high_m) continue;
    building +=
        Coloured(WallCloud(grid.grid, elevation, static_cast<std::uint32_t>(grid.floor)), colours);
  }
  (wanted.format == ExportFormat::kPcd ? WritePcd : WritePly)(building, path);
}

void WriteTree(const BuildingMap& result, const std::vector<FloorGrid>& grids,
               const OctreeOptions& options, const HeightBand& heights,
               const std::filesystem::path& path) {
  std::vector<FloorLayer> layers;
  for (const FloorGrid& grid : grids) {
    layers.push_back(
        {&grid.grid, result.graph.floors()[static_cast<std::size_t>(grid.floor)].elevation});
  }
  WriteOctomap(BuildOctree(layers, options, heights), path);
}

std::vector<PlanLayer> PlanLayers(const std::vector<FloorGrid>& grids) {
  std::vector<PlanLayer> layers;
  for (const FloorGrid& grid : grids) layers.push_back({grid.floor, FitWallLines(grid.grid)});
  return layers;
}

void WritePoses(const BuildingMap& result, const std::optional<FloorId>& floor,
                const std::filesystem::path& path) {
  std::vector<TrajectoryPose> poses;
  for (const TrajectoryPose& pose : result.trajectory) {
    if (!floor || pose.floor == *floor) poses.push_back(pose);
  }
  WriteTrajectory(poses, result.graph.floors(), path);
}

}  // namespace

const std::vector<std::string>& ExportFormatNames() {
  static const std::vector<std::string> names = {"octomap", "pcd", "ply",     "grid",
                                                 "tum",     "g2o", "geojson", "svg"};
  return names;
}

FloorId FloorOfLabel(const std::vector<Floor>& floors, const std::string& label) {
  const auto found = std::find_if(floors.begin(), floors.end(),
                                  [&](const Floor& floor) { return floor.label == label; });
  if (found == floors.end()) {
    throw InputError("the map has no floor `" + label + "`, it has " + Labels(floors));
  }
  return static_cast<FloorId>(found - floors.begin());
}

void CheckSingleExport(const SingleExport& wanted, const std::vector<Floor>& floors) {
  if (!HasHeights(wanted.format) && wanted.heights != HeightBand{}) {
    throw InputError("heights are for octomap, pcd and ply, not for " +
                     ExportFormatNames()[static_cast<std::size_t>(wanted.format)]);
  }
  if (!(wanted.heights.low_m <= wanted.heights.high_m)) {
    throw InputError("the lower height must not be above the upper");
  }
  if (wanted.format == ExportFormat::kGrid && !wanted.floor && floors.size() != 1) {
    throw InputError("a grid is of one floor, and the map has " + std::to_string(floors.size()) +
                     ": " + Labels(floors));
  }
}

std::vector<std::filesystem::path> WriteSingleExport(const BuildingMap& result,
                                                     const ExportOptions& options,
                                                     const SingleExport& wanted,
                                                     const std::filesystem::path& path) {
  CheckSingleExport(wanted, result.graph.floors());
  const auto grids = [&] { return RenderGrids(result, options.grid, wanted.floor); };
  switch (wanted.format) {
    case ExportFormat::kOctomap:
      WriteTree(result, grids(), options.octree, wanted.heights, path);
      break;
    case ExportFormat::kPcd:
    case ExportFormat::kPly:
      WriteClouds(result, grids(), wanted, path);
      break;
    case ExportFormat::kGrid: {
      std::filesystem::path stem = path;
      if (stem.extension() == ".pgm" || stem.extension() == ".yaml") stem.replace_extension();
      WriteOccupancyGrid(grids().front().grid, stem);
      return {stem.string() + ".pgm", stem.string() + ".yaml"};
    }
    case ExportFormat::kGeojson:
      WriteFile(path, GeoJsonText(result, PlanLayers(grids()), CrossingsOf(result)));
      break;
    case ExportFormat::kSvg:
      WriteFile(path, SvgText(result, PlanLayers(grids()), CrossingsOf(result)));
      break;
    case ExportFormat::kTum:
      WritePoses(result, wanted.floor, path);
      break;
    case ExportFormat::kG2o:
      if (wanted.floor) {
        WriteG2o(result.graph, *wanted.floor, path);
      } else {
        WriteG2o(result.graph, path);
      }
      break;
  }
  return {path};
}

}  // namespace masked_mapper
