// SPDX-License-Identifier: BSD-3-Clause
// Rendering and writing a floor of the paper's size: 264 x 82 m, 361 beams every 0.15 m of
// corridors.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "masked_mapper/export/map_export.hpp"

namespace masked_mapper {
namespace {

constexpr double kLength = 264.0;
constexpr double kHalfWidth = 1.2;  // of a corridor
constexpr int kCorridors = 6;
constexpr double kSpacing = 82.0 / kCorridors;

// A scan in a corridor along x, with the roughness of doors and noise.
LaserScan ScanInCorridor(const Pose2& pose, double corridor_y, int seed) {
  LaserScan scan;
  scan.first_angle = -0.75 * kPi;
  scan.angle_step = 1.5 * kPi / 360.0;
  scan.max_range = 30.0F;
  for (std::size_t beam = 0; beam < 361; ++beam) {
    const double angle = pose.theta + scan.Angle(beam);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double to_side = ((s > 0 ? kHalfWidth : -kHalfWidth) + corridor_y - pose.y) / s;
    const double to_end = ((c > 0 ? kLength : 0.0) - pose.x) / c;
    const double range = std::min(std::abs(to_side), std::abs(to_end));
    const double rough = 0.02 * std::sin(7.0 * (pose.x + range * c)) +
                         0.01 * std::sin(static_cast<double>(beam) * 12.9898 + seed);
    scan.ranges.push_back(range + rough < 30.0 ? static_cast<float>(range + rough) : kNoReturn);
  }
  return scan;
}

BuildingMap LargeFloor() {
  BuildingMap map;
  map.graph.AddFloor({"0", 3.7, 0.0, true});
  for (int corridor = 0; corridor < kCorridors; ++corridor) {
    const double y = kSpacing * (corridor + 0.5);
    for (double x = 1.0; x < kLength - 1.0; x += 0.15) {
      TrajectoryPose pose;
      pose.T_world_robot = {x, y, corridor % 2 == 0 ? 0.0 : kPi};
      const int seed = static_cast<int>(map.trajectory.size());
      map.kept_scans.push_back(
          {map.trajectory.size(), ScanInCorridor(pose.T_world_robot, y, seed)});
      map.trajectory.push_back(pose);
    }
  }
  return map;
}

void RenderLargeFloor(benchmark::State& state) {
  const BuildingMap map = LargeFloor();
  GridOptions options;
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(RenderFloors(map, options));
  state.counters["scans"] = static_cast<double>(map.kept_scans.size());
}
BENCHMARK(RenderLargeFloor)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void BuildOctreeOfLargeFloor(benchmark::State& state) {
  const OccupancyGrid grid = RenderFloors(LargeFloor(), {}).front();
  OctreeOptions options;
  if (state.range(0) == 1) options.free_height_m = grid.resolution_m;  // what cannot prune
  for (auto _ : state) benchmark::DoNotOptimize(BuildOctree({{&grid, 3.7}}, options));
}
BENCHMARK(BuildOctreeOfLargeFloor)
    ->ArgName("one_layer")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond);

void WriteLargeFloor(benchmark::State& state) {
  const BuildingMap map = LargeFloor();
  const auto folder = std::filesystem::temp_directory_path() / "masked_mapper_rendering_benchmark";
  ExportOptions options;
  options.grid.threads = static_cast<int>(state.range(0));
  std::filesystem::create_directory(folder);
  for (auto _ : state) WriteMap(map, {}, options, folder);
  state.counters["bt_MB"] =
      1e-6 * static_cast<double>(std::filesystem::file_size(folder / "building.bt"));
  std::filesystem::remove_all(folder);
}
BENCHMARK(WriteLargeFloor)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace masked_mapper
