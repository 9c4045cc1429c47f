// SPDX-License-Identifier: BSD-3-Clause
#include "truth.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "masked_mapper/log/floor_file.hpp"

namespace masked_mapper {
namespace {

constexpr double kSameStamp = 0.005;         // s: stamps are rounded in some files
constexpr double kLongestGap = 1.0;          // s between exact poses
constexpr double kFarthestCarriedKey = 5.0;  // s

const std::string kExactEnding = ".truth.tum";

bool IsNamedExact(const std::string& path) {
  return path.size() >= kExactEnding.size() &&
         path.compare(path.size() - kExactEnding.size(), std::string::npos, kExactEnding) == 0;
}

std::string FloorsPath(const std::string& path) {
  const std::string stem = IsNamedExact(path)
                               ? path.substr(0, path.size() - kExactEnding.size())
                               : std::filesystem::path(path).replace_extension().string();
  return stem + ".truth_floors.csv";
}

const StampedPose& Nearest(const std::vector<StampedPose>& poses, double stamp) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), stamp,
                       [](const StampedPose& pose, double value) { return pose.stamp < value; });
  if (after == poses.end()) return poses.back();
  if (after == poses.begin()) return *after;
  return after->stamp - stamp < stamp - std::prev(after)->stamp ? *after : *std::prev(after);
}

bool InsideAGap(const std::vector<StampedPose>& poses, double stamp) {
  const auto after =
      std::upper_bound(poses.begin(), poses.end(), stamp,
                       [](double value, const StampedPose& pose) { return value < pose.stamp; });
  return after != poses.begin() && after != poses.end() &&
         after->stamp - std::prev(after)->stamp > kLongestGap;
}

}  // namespace

Truth ReadTruth(const std::string& path) {
  Truth truth;
  truth.poses = ReadTrajectory(path);
  truth.exact = IsNamedExact(path);
  const std::string floors = FloorsPath(path);
  std::error_code error;
  if (std::filesystem::exists(floors, error)) truth.floors = ReadFloorFile(floors);
  return truth;
}

std::optional<StampedPose> TruePoseAt(const Truth& truth, double stamp) {
  if (truth.poses.empty()) return std::nullopt;
  const StampedPose& nearest = Nearest(truth.poses, stamp);
  if (truth.exact) {
    if (!InsideAGap(truth.poses, stamp)) return PoseAt(truth.poses, stamp, kSameStamp);
  }
  if (std::abs(nearest.stamp - stamp) > kSameStamp) return std::nullopt;
  return nearest;
}

std::optional<StampedPose> CarriedTruePoseAt(const Truth& truth,
                                             const std::vector<StampedPose>& trajectory,
                                             double stamp) {
  if (truth.exact || truth.poses.empty()) return TruePoseAt(truth, stamp);
  const StampedPose& key = Nearest(truth.poses, stamp);
  if (std::abs(key.stamp - stamp) > kFarthestCarriedKey) return std::nullopt;
  const std::optional<StampedPose> at_key = PoseAt(trajectory, key.stamp);
  const std::optional<StampedPose> at_stamp = PoseAt(trajectory, stamp);
  if (!at_key || !at_stamp) return std::nullopt;
  const Pose2 T_key_stamp = Between(at_key->T_world_robot, at_stamp->T_world_robot);
  return StampedPose{stamp, key.T_world_robot * T_key_stamp, key.z};
}

std::vector<std::optional<StampedPose>> TruePosesOf(const std::vector<double>& log_stamps,
                                                    const Truth& truth,
                                                    const std::vector<StampedPose>& trajectory) {
  std::vector<std::optional<StampedPose>> poses;
  poses.reserve(log_stamps.size());
  for (const double stamp : log_stamps) {
    poses.push_back(CarriedTruePoseAt(truth, trajectory, stamp));
  }
  return poses;
}

}  // namespace masked_mapper
