// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_error.hpp"

#include <cmath>
#include <utility>

#include "error_statistics.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

/// The poses of the truth and of the map at the same stamps.
struct Paired {
  std::vector<Pose2> T_truth_robot;
  std::vector<Pose2> T_map_robot;

  void Add(const Pose2& truth, const Pose2& map) {
    T_truth_robot.push_back(truth);
    T_map_robot.push_back(map);
  }
};

AbsoluteError ErrorOf(const Paired& paired, const Pose2& T_truth_map) {
  std::vector<double> distances;
  std::vector<double> turns_deg;
  for (std::size_t i = 0; i < paired.T_map_robot.size(); ++i) {
    const Pose2 estimate = T_truth_map * paired.T_map_robot[i];
    const Pose2& truth = paired.T_truth_robot[i];
    distances.push_back(Distance(truth, estimate));
    turns_deg.push_back(RadToDeg(std::abs(WrapAngle(estimate.theta - truth.theta))));
  }
  return {StatisticsOf(distances), StatisticsOf(turns_deg)};
}

AbsoluteError AlignedErrorOf(const Paired& paired) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> places;
  for (std::size_t i = 0; i < paired.T_truth_robot.size(); ++i) {
    places.emplace_back(paired.T_truth_robot[i].Translation(), paired.T_map_robot[i].Translation());
  }
  const Pose2 T_truth_map = AlignRigidly(places);
  return ErrorOf(paired, T_truth_map);
}

// Each stretch begins at a paired scan and ends at the first one that is so far along the true way.
void CompareStretches(const Paired& paired, TrajectoryError& error) {
  std::vector<double> travelled(paired.T_truth_robot.size(), 0.0);
  for (std::size_t i = 1; i < travelled.size(); ++i) {
    travelled[i] =
        travelled[i - 1] + Distance(paired.T_truth_robot[i - 1], paired.T_truth_robot[i]);
  }
  std::vector<double> translations;
  std::vector<double> rotations_deg;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < travelled.size(); ++begin) {
    while (end < travelled.size() && travelled[end] - travelled[begin] < error.relative_over_m) {
      ++end;
    }
    if (end == travelled.size()) break;
    const Pose2 left = Between(Between(paired.T_truth_robot[begin], paired.T_truth_robot[end]),
                               Between(paired.T_map_robot[begin], paired.T_map_robot[end]));
    translations.push_back(std::hypot(left.x, left.y));
    rotations_deg.push_back(RadToDeg(std::abs(left.theta)));
  }
  error.relative_translation_m = StatisticsOf(translations);
  error.relative_rotation_deg = StatisticsOf(rotations_deg);
}

}  // namespace

std::optional<TrajectoryError> CompareWithTruth(const std::vector<StampedPose>& trajectory,
                                                const Truth& truth,
                                                const std::vector<MappedFloor>& floors) {
  TrajectoryError error;
  error.scans = trajectory.size();
  Paired all;
  std::vector<Paired> by_floor(floors.size());
  std::vector<double> elevations;
  for (const StampedPose& pose : trajectory) {
    const std::optional<StampedPose> true_pose = TruePoseAt(truth, pose.stamp);
    if (!true_pose) continue;
    all.Add(true_pose->T_world_robot, pose.T_world_robot);
    elevations.push_back(std::abs(pose.z - true_pose->z));
    if (floors.empty()) continue;
    by_floor[NearestFloor(floors, pose.z)].Add(true_pose->T_world_robot, pose.T_world_robot);
  }
  error.paired = elevations.size();
  if (error.paired == 0) return std::nullopt;
  error.as_it_stands = ErrorOf(all, {});
  error.aligned = AlignedErrorOf(all);
  error.elevation_m = StatisticsOf(elevations);
  CompareStretches(all, error);
  for (std::size_t i = 0; i < floors.size(); ++i) {
    if (by_floor[i].T_map_robot.empty()) continue;
    error.floors.push_back(
        {floors[i].label, ErrorOf(by_floor[i], {}), AlignedErrorOf(by_floor[i])});
  }
  return error;
}

}  // namespace masked_mapper
