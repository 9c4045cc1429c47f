// SPDX-License-Identifier: BSD-3-Clause
#include "export_space.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>

#include "aside_folder.hpp"
#include "interrupt.hpp"
#include "masked_mapper/export/space_export.hpp"
#include "masked_mapper/log/cloud_source.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "progress_bar.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

std::optional<SpaceFormat> PointFormat(const std::string& name) {
  if (name == "pcd") return SpaceFormat::kPcd;
  if (name == "ply") return SpaceFormat::kPly;
  if (name == "las") return SpaceFormat::kLas;
  return std::nullopt;
}

/// Adds all clouds of the logs, in their order, or all that the map keeps, to each of `spaces`.
template <typename... Spaces>
void ReadClouds(const SavedMap& map, const SpaceRequest& request, const std::string& stage,
                ProgressBar& progress, Spaces*... spaces) {
  const auto add = [&](const auto&... what) {
    const auto add_to = [&](auto* space) {
      if (space != nullptr) space->Add(what...);
    };
    (add_to(spaces), ...);
  };
  progress.Stage(stage);
  if (request.logs.empty()) {
    std::size_t taken = 0;
    const std::size_t all = map.result.kept_clouds.size();
    ForEachKeptCloud(map.result, 1, [&](const LevelledCloud& cloud, std::size_t trajectory_index) {
      add(cloud, trajectory_index);
      progress.Progress(static_cast<double>(++taken) / static_cast<double>(all), 0);
    });
    return;
  }
  CloudSource source(request.logs, map.origin.options.mapping.log);
  while (const std::optional<LevelledCloud> cloud = source.Next()) {
    add(*cloud);
    progress.Progress(source.Progress(), 0);
  }
}

void CheckTaken(const SpaceRequest& request, const CloudCounts& clouds) {
  if (clouds.taken > 0) return;
  if (request.logs.empty()) throw InputError("the map keeps no cloud of what is asked for");
  throw InputError(request.logs.front() + ": none of its clouds is of this map (" +
                   std::to_string(clouds.unknown) + " have other stamps)");
}

/// The names of the files in `folder`, and what to say of them.
struct Written {
  std::vector<std::string> files;
  std::string remark;
};

SpaceOccupancyOptions RaysOf(const SavedMap& map, const SpaceRequest& request) {
  Options as_mapped = map.origin.options;
  SettleThreads(as_mapped);
  SpaceOccupancyOptions options;
  options.votes.resolution_m = as_mapped.grid.resolution_m;
  options.votes.threads = as_mapped.grid.threads;
  options.max_range_m = as_mapped.grid.max_usable_range_m;
  options.floor = request.floor;
  options.memory_mib = request.memory_mib;
  if (request.logs.empty()) options.spacing = kSpacingOfKept;
  return options;
}

/// Voxels in which one who walks by is a few, and that a wall's noise does not reach through.
SpaceOccupancyOptions RaysBetweenPoints(const SavedMap& map, const SpaceRequest& request) {
  constexpr double kPartOfABody = 0.1;  // m
  SpaceOccupancyOptions options = RaysOf(map, request);
  options.votes.resolution_m = std::max(kPartOfABody, options.votes.resolution_m);
  return options;
}

Written WritePoints(const SavedMap& map, const SpaceRequest& request, const fs::path& folder,
                    ProgressBar& progress) {
  SpaceExportOptions options;
  options.voxel_m = request.voxel_m;
  if (request.logs.empty()) options.spacing = kSpacingOfKept;
  options.max_range_m = map.origin.options.grid.max_usable_range_m;
  options.floor = request.floor;
  options.heights = request.heights;
  SpaceExport space(map.result, options);
  std::optional<SpaceOccupancy> rays;
  if (!request.keeps_passers_by) rays.emplace(map.result, RaysBetweenPoints(map, request));
  ReadClouds(map, request, "placing clouds", progress, &space, rays ? &*rays : nullptr);
  CheckTaken(request, space.clouds());
  const std::string remark = std::to_string(space.clouds().taken) + " clouds";
  while (rays && rays->Finish()) {
    ReadClouds(map, request, "casting rays of other floors", progress, &*rays);
  }
  progress.Stage("writing");
  const std::string name = fs::path(request.file).filename();
  const std::size_t points =
      space.Write(*PointFormat(request.format), folder / name, rays ? &*rays : nullptr);
  return {{name}, remark + ", " + std::to_string(points) + " points"};
}

Written WriteOccupancy(const SavedMap& map, const SpaceRequest& request, const fs::path& folder,
                       ProgressBar& progress) {
  SpaceOccupancyOptions options = RaysOf(map, request);
  options.heights = request.heights;
  SpaceOccupancy space(map.result, options);
  std::size_t clouds = 0;
  std::size_t passes = 0;
  do {
    ++passes;
    ReadClouds(map, request, passes > 1 ? "casting rays of other floors" : "casting rays", progress,
               &space);
    if (passes == 1) CheckTaken(request, space.clouds());
    if (passes == 1) clouds = space.clouds().taken;
  } while (space.Finish());
  progress.Stage("writing");
  const std::string remark =
      std::to_string(clouds) + " clouds, " + std::to_string(std::lround(space.peak_mib())) +
      " MiB of voxels" + (passes > 1 ? ", clouds read " + std::to_string(passes) + " times" : "");
  fs::path name = fs::path(request.file).filename();
  if (request.format == "octomap") {
    space.WriteOctree(folder / name);
    return {{name.string()}, remark};
  }
  if (name.extension() == ".pgm" || name.extension() == ".yaml") name.replace_extension();
  space.WriteGrid(*request.floor, request.robot, folder / name);
  return {{name.string() + ".pgm", name.string() + ".yaml"}, remark};
}

}  // namespace

void CheckSpaceRequest(const SpaceRequest& request) {
  const bool is_grid = request.format == "grid";
  if (!PointFormat(request.format) && !is_grid && request.format != "octomap") {
    throw InputError("export: --clouds is for octomap, pcd, ply, las and grid, not for `" +
                     request.format + "`");
  }
  if (is_grid && request.heights != HeightBand{}) {
    throw InputError(
        "export: heights are for octomap, pcd, ply and las; what is in a robot's way "
        "in a grid, --robot-height tells");
  }
  if (!(request.heights.low_m <= request.heights.high_m)) {
    throw InputError("the lower height must not be above the upper");
  }
  FileToWrite(request.file);
}

int ExportSpace(const SavedMap& map, const SpaceRequest& wanted) {
  SpaceRequest request = wanted;
  if (request.logs.empty() && map.result.kept_clouds.empty()) {
    throw InputError("the map keeps no clouds: give their log, with --clouds LOG");
  }
  const std::vector<Floor>& floors = map.result.graph.floors();
  if (request.format == "grid" && !request.floor) {
    if (floors.size() != 1) {
      throw InputError("a grid is of one floor, and the map has " + std::to_string(floors.size()) +
                       ": choose one with --floor");
    }
    request.floor = 0;
  }
  CatchInterrupts();
  ProgressBar progress(request.quiet);
  const fs::path file = fs::absolute(request.file);
  const AsideFolder aside(file);
  const bool is_points = PointFormat(request.format).has_value();
  const Written written =
      (is_points ? WritePoints : WriteOccupancy)(map, request, aside.path(), progress);
  std::string names;
  for (const std::string& name : written.files) {
    fs::rename(aside.path() / name, file.parent_path() / name);
    const fs::path shown = fs::path(request.file).parent_path() / name;
    names += (names.empty() ? "" : ", ") + shown.string();
  }
  progress.Finish();
  if (!request.quiet) {
    std::cout << request.format << ": " << names << " (" << written.remark << ")\n";
  }
  return 0;
}

}  // namespace masked_mapper
