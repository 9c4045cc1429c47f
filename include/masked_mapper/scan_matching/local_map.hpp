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

class LocalMap {
 public:
  /// Points will be kept within `reach_m` of `center_in_map`.
  LocalMap(const LocalMapOptions& options, const Eigen::Vector2d& center_in_map);

  struct PosedPoints {
    ScanPoints::ConstPtr points_in_robot;
    Pose2 T_map_robot;
  };
  void Add(const ScanPoints& points_in_robot, const Pose2& T_map_robot);
  /// The same as one after the other, at less cost.
  void Add(const std::vector<PosedPoints>& scans);

  /// Gauss-Newton from `T_map_robot_guess`, held by `prior_information` of the guess (zero: free).
  /// Without a point in reach of the map: the guess, zero information, not converged.
  Alignment Align(const ScanPoints& points_in_robot, const Pose2& T_map_robot_guess,
                  const Eigen::Matrix3d& prior_information) const;

  /// The same with a guess that keeps its say whatever the points hold against it.
  Alignment AlignHeld(const ScanPoints& points_in_robot, const Pose2& T_map_robot_guess,
                      const Eigen::Matrix3d& prior_information) const;

  /// Share of the points that agree with the map at a pose, 0-1: a cheap score to compare guesses.
  double Agreement(const ScanPoints& points_in_robot, const Pose2& T_map_robot,
                   double sigma_m) const;

  std::size_t scans() const { return scans_; }

  /// The state, for a checkpoint (mapping/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    // Most cells are empty: which cell a slot is of takes less room than the slot of every cell.
    std::vector<std::int32_t> cell_of_slot(moments_.size() / kSides);
    for (std::size_t cell = 0; cell < slot_of_cell_.size(); ++cell) {
      const std::int32_t slot = slot_of_cell_[cell];
      if (slot >= 0) cell_of_slot[static_cast<std::size_t>(slot)] = static_cast<std::int32_t>(cell);
    }
    archive(corner_, cell_of_slot, moments_, distributions_, scans_, front_rad_);
    if constexpr (Archive::kReads) {
      if (moments_.size() != kSides * cell_of_slot.size() ||
          distributions_.size() != (kSides + 1) * cell_of_slot.size()) {
        archive.Refuse("a local map that does not hold together");
      }
      slot_of_cell_.assign(slot_of_cell_.size(), -1);
      for (std::size_t slot = 0; slot < cell_of_slot.size(); ++slot) {
        const std::int32_t cell = cell_of_slot[slot];
        if (cell < 0 || static_cast<std::size_t>(cell) >= slot_of_cell_.size()) {
          archive.Refuse("a local map with a cell outside");
        }
        slot_of_cell_[static_cast<std::size_t>(cell)] = static_cast<std::int32_t>(slot);
      }
    }
  }

 private:
  static constexpr std::size_t kSides = 4;

  struct Moments {
    double count = 0.0;
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;  ///< sums, about the cell's center

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

    template <class Archive>
    void Serialize(Archive& archive) {
      archive(mean_x, mean_y, normal_x, normal_y, small, large, is_line, is_known);
    }
  };

  Alignment Align(const ScanPoints& points_in_robot, const Pose2& T_map_robot_guess,
                  const Eigen::Matrix3d& prior_information, double guess_outlier_sigmas) const;
  int Index(double x, double y) const;
  std::size_t AddSlot(int index);
  std::vector<std::uint8_t> SidesOf(const std::vector<Eigen::Vector2f>& normals,
                                    double theta) const;
  void Insert(const ScanPoints& points_in_robot, const Pose2& T_map_robot,
              std::vector<int>& touched);
  void UpdateAround(std::vector<int> touched);
  void UpdateDistributions(int column, int row);
  /// The moments of each side over the window around a cell, about its center.
  void SumAround(int column, int row, std::array<Moments, kSides + 1>& sums) const;
  void Describe(const Moments& sum, int column, int row, Distribution& distribution) const;
  double Step(const ScanPoints& points, const std::vector<std::uint8_t>& sides,
              const Pose2& T_map_robot, double sigma_m, Eigen::Matrix3d& hessian,
              Eigen::Vector3d& gradient) const;

  LocalMapOptions options_;
  double front_rad_ = 0.0;                  ///< surfaces that face within 90 deg of it are in front
  Eigen::Vector2d corner_;                  ///< of cell (0, 0), in map
  int width_ = 0;                           ///< cells to a side
  std::vector<std::int32_t> slot_of_cell_;  ///< -1: nothing near
  std::vector<Moments> moments_;            ///< of each slot, side by side
  std::vector<Distribution> distributions_;  ///< alike
  std::size_t scans_ = 0;
};

}  // namespace masked_mapper
