// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/space_export.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cloud_poses.hpp"
#include "masked_mapper/rendering/space_votes.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "occupancy_grid_file.hpp"
#include "octomap_file.hpp"

namespace masked_mapper {
namespace {

constexpr double kMib = 1024.0 * 1024.0;
constexpr double kFarthestVoxel = 1 << 19;  // from the origin

}  // namespace

class SpaceOccupancy::Impl {
 public:
  Impl(const BuildingMap& map, const SpaceOccupancyOptions& options);

  CloudPoses& poses() { return *poses_; }
  /// At a pose of `poses()`; null: nowhere.
  void Add(const LevelledCloud& cloud, const TrajectoryPose* pose);
  bool Finish();
  Cell At(FloorId floor, const Eigen::Vector3d& place_in_world) const;
  CloudCounts clouds() const { return poses_->counts(); }
  double peak_mib() const { return peak_mib_; }
  void WriteOctree(const std::filesystem::path& path) const;
  void WriteGrid(FloorId floor, const RobotHeights& heights,
                 const std::filesystem::path& stem) const;

 private:
  struct FloorVotes {
    std::optional<SpaceVotes> votes;
    SpaceStates states;  ///< once all is seen
    bool is_done = false;
    bool waits = false;  ///< for the next pass of the log
  };

  double VotesMib() const;
  void KeepWithinMemory();

  const BuildingMap& map_;
  SpaceOccupancyOptions options_;
  std::optional<CloudPoses> poses_;
  std::vector<FloorVotes> floors_;  ///< by id
  double peak_mib_ = 0.0;
};

SpaceOccupancy::Impl::Impl(const BuildingMap& map, const SpaceOccupancyOptions& options)
    : map_(map), options_(options), floors_(map.graph.floors().size()) {
  poses_.emplace(map, options.spacing, options.floor);
}

double SpaceOccupancy::Impl::VotesMib() const {
  std::size_t bytes = 0;
  for (const FloorVotes& floor : floors_) {
    if (floor.votes) bytes += floor.votes->bytes();
    bytes += floor.states.blocks().size() * sizeof(SpaceBlock);
  }
  return static_cast<double>(bytes) / kMib;
}

void SpaceOccupancy::Impl::KeepWithinMemory() {
  for (double mib = VotesMib();; mib = VotesMib()) {
    peak_mib_ = std::max(peak_mib_, mib);
    if (mib <= options_.memory_mib) return;
    const auto has_votes = [](const FloorVotes& floor) { return floor.votes.has_value(); };
    const auto last = std::find_if(floors_.rbegin(), floors_.rend(), has_votes);
    if (std::count_if(floors_.begin(), floors_.end(), has_votes) < 2) {
      const auto floor = static_cast<std::size_t>(floors_.rend() - last) - 1;
      throw InputError("floor " + map_.graph.floors()[floor].label + " in voxels of " +
                       ShortText(options_.votes.resolution_m) + " m takes more than " +
                       FixedText(options_.memory_mib, 0) +
                       " MiB: choose a coarser --resolution, or more --memory");
    }
    last->votes.reset();
    last->waits = true;
  }
}

void SpaceOccupancy::Impl::Add(const LevelledCloud& cloud, const TrajectoryPose* pose) {
  if (pose == nullptr) return;
  FloorVotes& floor = floors_[static_cast<std::size_t>(pose->floor)];
  if (floor.is_done || floor.waits) return;
  if (!floor.votes) floor.votes.emplace(options_.votes);
  const Eigen::Isometry3d T_world_level = poses_->T_world_level(*pose);
  const Eigen::Vector3f lidar = cloud.lidar.cast<float>();
  std::vector<Eigen::Vector3f> ends;
  ends.reserve(cloud.points.size());
  for (const CloudPoint& point : cloud.points) {
    if ((point.position - lidar).norm() > static_cast<float>(options_.max_range_m)) continue;
    ends.emplace_back((T_world_level * point.position.cast<double>()).cast<float>());
  }
  const double floor_m = T_world_level.translation().z();
  std::optional<double> ceiling_m = cloud.ceiling_m;
  if (ceiling_m) *ceiling_m += floor_m;
  floor.votes->Add(T_world_level * cloud.lidar, std::move(ends), floor_m, ceiling_m);
  KeepWithinMemory();
}

bool SpaceOccupancy::Impl::Finish() {
  bool is_more = false;
  for (FloorVotes& floor : floors_) {
    if (floor.votes) {
      floor.states = floor.votes->Count();
      floor.votes.reset();
      floor.is_done = true;
    }
    is_more = is_more || floor.waits;
    floor.waits = false;
  }
  poses_.emplace(map_, options_.spacing, options_.floor);
  return is_more;
}

Cell SpaceOccupancy::Impl::At(FloorId floor, const Eigen::Vector3d& place_in_world) const {
  VoxelIndex voxel{};
  for (int axis = 0; axis < 3; ++axis) {
    const double index = std::floor(place_in_world(axis) / options_.votes.resolution_m);
    if (!(std::abs(index) < kFarthestVoxel)) return Cell::kUnknown;
    voxel[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(index);
  }
  return floors_[static_cast<std::size_t>(floor)].states.At(voxel);
}

void SpaceOccupancy::Impl::WriteOctree(const std::filesystem::path& path) const {
  std::vector<const SpaceStates*> states;
  for (const FloorVotes& floor : floors_) states.push_back(&floor.states);
  WriteOctomap(BuildSpaceOctree(states, options_.heights), path);
}

void SpaceOccupancy::Impl::WriteGrid(FloorId floor, const RobotHeights& heights,
                                     const std::filesystem::path& stem) const {
  const auto f = static_cast<std::size_t>(floor);
  const double elevation = map_.graph.floors()[f].elevation;
  WriteOccupancyGrid(
      GridBetween(floors_[f].states, elevation + heights.low_m, elevation + heights.high_m), stem);
}

SpaceOccupancy::SpaceOccupancy(const BuildingMap& map, const SpaceOccupancyOptions& options)
    : impl_(std::make_unique<Impl>(map, options)) {}
SpaceOccupancy::~SpaceOccupancy() = default;

void SpaceOccupancy::Add(const LevelledCloud& cloud) {
  impl_->Add(cloud, impl_->poses().Take(cloud.log_stamp));
}
void SpaceOccupancy::Add(const LevelledCloud& cloud, std::size_t trajectory_index) {
  impl_->Add(cloud, impl_->poses().TakeAt(trajectory_index));
}
bool SpaceOccupancy::Finish() { return impl_->Finish(); }
Cell SpaceOccupancy::At(FloorId floor, const Eigen::Vector3d& place_in_world) const {
  return impl_->At(floor, place_in_world);
}
CloudCounts SpaceOccupancy::clouds() const { return impl_->clouds(); }
double SpaceOccupancy::peak_mib() const { return impl_->peak_mib(); }
void SpaceOccupancy::WriteOctree(const std::filesystem::path& path) const {
  impl_->WriteOctree(path);
}
void SpaceOccupancy::WriteGrid(FloorId floor, const RobotHeights& heights,
                               const std::filesystem::path& stem) const {
  impl_->WriteGrid(floor, heights, stem);
}

}  // namespace masked_mapper
