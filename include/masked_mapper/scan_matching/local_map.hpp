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
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/scan_matching/cell_slots.hpp"
#include "masked_mapper/scan_matching/faced_points.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

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

struct Alignment {
  Pose2 T_map_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan alone, of (x, y, theta)
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

  std::size_t scans() const { return scans_; }

  /// The state, for a checkpoint (sensor/state_archive.hpp). What is known of a cell's
  /// surroundings follows from its points.
  template <class Archive>
  void Serialize(Archive& archive) {
    std::vector<std::int32_t> cells = slots_.cells();
    archive(corner_, cells, moments_, scans_, front_rad_);
    if constexpr (Archive::kReads) {
      if (moments_.size() != kSides * cells.size()) {
        archive.Refuse("a local map that does not hold together");
      }
      if (!slots_.Take(cells)) archive.Refuse("a local map with a cell outside, or one twice");
      known_.assign(cells.size(), {});
    }
  }

 private:
  static constexpr std::size_t kSides = 4;

  struct Moments {
    double count = 0.0;
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;  ///< sums, about the cell's center

    void operator+=(const Moments& other);

    template <class Archive>
    void Serialize(Archive& archive) {
      archive(count, x, y, xx, xy, yy);
    }
  };
  struct Distribution {
    float mean_x = 0.0F, mean_y = 0.0F;      ///< in map
    float normal_x = 0.0F, normal_y = 0.0F;  ///< direction of the smaller variance
    float small = 0.0F, large = 0.0F;        ///< variances, m^2
    bool is_line = false;
    bool is_known = false;
  };
  /// What is known of a cell's surroundings: of each side, and of all of them together.
  struct Surroundings {
    std::array<Distribution, kSides + 1> of_side;
    std::uint8_t settled = 0;  ///< a bit for each side: no point came since it was worked out
  };
  using Cell = CellSlots::Cell;

  Alignment Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                  const Eigen::Matrix3d& prior_information, double guess_outlier_sigmas) const;
  bool FindCell(double x, double y, Cell* cell) const;
  std::size_t AddSlot(Cell cell);
  std::vector<std::uint8_t> SidesOf(const FacedPoints& points, double theta) const;
  std::size_t MarkAround(Cell cell, std::size_t side);
  const Distribution& Seen(std::size_t slot, std::size_t side) const;
  const Distribution& Settled(std::size_t slot, std::size_t side) const;
  Moments SumAround(Cell cell, std::size_t side) const;
  void Describe(const Moments& sum, Cell cell, Distribution& distribution) const;
  double Step(const FacedPoints& points, const std::vector<std::uint8_t>& sides,
              const Pose2& T_map_robot, double sigma_m, Eigen::Matrix3d& hessian,
              Eigen::Vector3d& gradient) const;

  LocalMapOptions options_;
  double cells_per_m_;
  double front_rad_ = 0.0;  ///< surfaces that face within 90 deg of it are in front
  Eigen::Vector2d corner_;  ///< of cell (0, 0), in map
  CellSlots slots_;
  std::vector<Moments> moments_;             ///< of each slot, side by side
  mutable std::vector<Surroundings> known_;  ///< of each slot, worked out where it is looked at
  std::size_t scans_ = 0;
};

}  // namespace masked_mapper
