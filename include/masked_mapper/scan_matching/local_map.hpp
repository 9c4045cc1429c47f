// SPDX-License-Identifier: BSD-3-Clause
// A small map of a few recent scans, to which the next scan is aligned below the size of any cell.
//
// A normal-distributions map whose windows overlap: every cell knows the mean and covariance of the
// points in the cells around it, so a point finds its distribution in one look-up, and walls stay
// lines across cell borders. Points on a wall pull along its normal alone: a blank corridor says
// nothing about the way along it, and the covariance tells so. What is seen from one side and from
// the other is kept apart: a wall is thinner than a window, and a mixture of both faces would pull
// a robot that passes a door and turns. The paper takes motion as given; this is ours.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "masked_mapper/sensor/state_archive.hpp"

namespace masked_mapper {

struct LocalMapOptions {
  double cell_m = 0.15;         ///< size of a cell
  int window_cells = 1;         ///< cells to each side that a distribution looks at
  double reach_m = 40.0;        ///< points farther than this from the map's origin are left out
  double point_sigma_m = 0.01;  ///< noise of a point, added to every distribution
  double first_sigma_m = 0.15;  ///< the same in the first iteration, halved with each that follows
  double outlier_sigmas = 3.0;  ///< distance at which a point keeps a quarter of its say
  double guess_outlier_sigmas = 2.0;  ///< the same for the guess an alignment is held by
  double line_ratio = 0.1;  ///< smaller over larger variance, below which points form a line
  int max_iterations = 15;
  double covariance_inflation = 2.0;  ///< beams of one wall err together, not each on its own
};

/// The points of a scan with the way in which the surface faces at each: made once of a scan, which
/// may then be held against local maps and added to them any number of times.
/// All in the robot's frame, m, in the order of the beams.
struct FacedPoints {
  FacedPoints() = default;
  /// A surface is the line through the neighbours of a point, and faces the robot: beams on another
  /// surface are none. Where there are none the point faces the robot. Not `explicit`, since points
  /// are all that it takes.
  FacedPoints(const ScanPoints& points_in_robot);  // NOLINT(google-explicit-constructor)

  std::size_t size() const { return x.size(); }
  bool empty() const { return x.empty(); }

  std::vector<float> x, y;
  std::vector<float> normal_x, normal_y;  ///< of any length
};

/// The heading, rad, midway between those in which most of the surfaces face, as in a building of
/// right angles.
double FrontOf(const FacedPoints& points, double theta);

struct Alignment {
  Pose2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan alone, of (x, y, theta)
  /// Of its (x, y), in map: what the noise of the walls' directions makes up. Walls that are known
  /// by few points seem to tell a little of the way along them, too.
  Eigen::Matrix2d information_of_noise = Eigen::Matrix2d::Zero();
  double inlier_share = 0.0;  ///< of the points that lie within the map's cells and agree, 0-1
  int iterations = 0;
  bool converged = false;
};

/// Not to be looked at by several threads at once: what a cell's surroundings look like is worked
/// out when a point first asks for it, since most of them change many times before one does.
class LocalMap {
 public:
  /// Points will be kept within `reach_m` of `center_in_map`.
  LocalMap(const LocalMapOptions& options, const Eigen::Vector2d& center_in_map);
  ~LocalMap();
  LocalMap(LocalMap&&) noexcept;
  LocalMap& operator=(LocalMap&&) noexcept;

  void Add(const FacedPoints& points_in_robot, const Pose2& T_map_robot);

  /// Gauss-Newton from `T_map_robot_guess`, held by `prior_information` of the guess (zero: free).
  /// Without a point in reach of the map: the guess, zero information, not converged.
  Alignment Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                  const Eigen::Matrix3d& prior_information) const;

  /// The same with a guess that keeps its say whatever the points hold against it.
  Alignment AlignHeld(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                      const Eigen::Matrix3d& prior_information) const;

  /// Share of the points that agree with the map at a pose, 0-1: a cheap score to compare guesses.
  double Agreement(const FacedPoints& points_in_robot, const Pose2& T_map_robot,
                   double sigma_m) const;

  std::size_t scans() const;

  /// The state, for a checkpoint.
  void Serialize(StateWriter& archive);
  void Serialize(StateReader& archive);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
