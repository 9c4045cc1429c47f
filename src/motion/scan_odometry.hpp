// SPDX-License-Identifier: BSD-3-Clause
// Scan odometry: every scan that moved is aligned to a rolling local map of the scans before it,
// held by what the wheels say. It makes the path between nodes good; it never closes a loop. The
// paper takes its motion from wheels and a gyro; this is ours.
#pragma once

#include <limits>
#include <optional>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/scan_matching/local_map.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

class ScanOdometry {
 public:
  explicit ScanOdometry(const ScanOdometryOptions& options) : options_(options) {}

  /// Motion since the scan before (or the first scan: identity), corrected. `T_last_now` is what
  /// the wheels say it was; without wheels a guess with a covariance to match.
  /// `must_match`: match this scan however little the robot moved, since what is not corrected now
  /// never will be. `points`: of the whole scan, where somebody has made them already.
  /// `tells_alone`: no wheels do, and seen_of_step() will be asked.
  UncertainPose2 Observe(const LaserScan& scan, const UncertainPose2& T_last_now,
                         bool must_match = false, const FacedPoints* points = nullptr,
                         bool tells_alone = false);

  /// The robot is somewhere else altogether: forget the local maps, go on from here, and look as
  /// far as there is to see.
  void Restart();
  /// From now on the scene may become another one at any scan. What was seen near the robot may
  /// stay, so the local maps do; what is farther off is not looked at.
  void EnterTransit();
  /// The robot is said to be on a floor again: forget the local maps and look as far as there is to
  /// see. A door may still open late, so for a while the scene is held under suspicion.
  void LeaveTransit();

  /// Sigma of the heading of the last observed scan against the local map by its points alone,
  /// radians; infinite if it was not matched.
  double heading_sigma_rad() const { return heading_sigma_rad_; }

  /// Information on (x, y) of the last step, in the frame that it begins in, that is the scan's
  /// alone and no noise of walls; zero if it was not matched. Known where `tells_alone` was asked.
  const Eigen::Matrix2d& seen_of_step() const { return seen_of_step_; }

  /// Share of the last matched scan that agreed with the local map, 0-1.
  double inlier_share() const { return inlier_share_; }

  /// Scans in the local map; 0: there is none.
  std::size_t map_scans() const { return maps_.current ? maps_.current->scans() : 0; }

  /// The state, for a checkpoint (sensor/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(path_.T_map_robot, maps_.T_map_keyframe, path_.T_matched_robot, path_.T_map_matched,
            path_.last_step);
    for (std::optional<LocalMap>* map : {&maps_.current, &maps_.next}) {
      bool present = map->has_value();
      archive(present);
      if (present && !*map) map->emplace(options_.map, Eigen::Vector2d::Zero());
      if (!present) map->reset();
      if (present) archive(**map);
    }
    archive(path_.heading_variance, rest_scans_, heading_sigma_rad_, inlier_share_, reach_m_,
            suspected_m_, lost_);
  }

 private:
  /// Where the robot is in the local map, and how that is known.
  struct Path {
    Pose2 T_map_robot;               ///< of the scan seen last
    UncertainPose2 T_matched_robot;  ///< by wheels since the scan matched last
    Pose2 T_map_matched;
    Pose2 last_step;                ///< from the match before last to the last
    double heading_variance = 0.0;  ///< of T_map_matched, rad^2
  };
  struct Maps {
    std::optional<LocalMap> current;      ///< matched against
    std::optional<LocalMap> next;         ///< grows until it is large enough to take over
    std::optional<Pose2> T_map_keyframe;  ///< of the scan added last
  };
  /// What is looked at of a scan, made when it is.
  class View {
   public:
    View(const LaserScan& scan, double reach_m, const FacedPoints* all_points)
        : scan_(scan), reach_m_(reach_m), given_(all_points) {}

    const FacedPoints& Points() { return Within(reach_m_, &points_); }
    /// Where the points of a map end, they would hold back a robot that moves on: it gets more.
    const FacedPoints& MapPoints();
    const FacedPoints& AllPoints();
    bool SeesAll() const { return std::isinf(reach_m_); }
    void SeeAll() { reach_m_ = std::numeric_limits<double>::infinity(); }

   private:
    const FacedPoints& Within(double reach_m, std::optional<FacedPoints>* points);

    const LaserScan& scan_;
    double reach_m_;
    const FacedPoints* given_;  ///< all; null: nobody has made them
    std::optional<FacedPoints> points_, map_points_, all_points_;
  };
  /// What the wheels say since the scan matched last.
  struct Prediction {
    double travelled_m = 0.0;
    double turned_rad = 0.0;
    bool is_at_rest = false;
    Eigen::Matrix3d motion_in_map = Eigen::Matrix3d::Zero();  ///< covariance
    /// The same with the doubt of the last match's heading, and its information.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d prior = Eigen::Matrix3d::Zero();
  };

  void Begin(View& view, const Pose2& T_last_now);
  bool Predict(const UncertainPose2& T_last_now);
  Prediction PriorOf(bool is_at_rest) const;
  bool NeedsNoMatch() const;
  bool IsAnotherScene(View& view) const;
  bool IsSameSceneAsAWhole(View& view) const;
  bool Believe(const View& view, const Alignment& aligned, const Prediction& predicted,
               bool must_match) const;
  UncertainPose2 Fuse(const Alignment& aligned, const Prediction& predicted,
                      const Pose2& T_map_last);
  double ShareOf(const Prediction& predicted) const;
  Eigen::Matrix2d SeenOfStep(const Alignment& aligned, const Prediction& predicted,
                             const Pose2& T_map_last) const;
  UncertainPose2 GoOnByWheels(const Pose2& by_wheels, const Prediction& predicted);
  void BeginAnew(View& view);
  void KeepMap(View& view);
  void AddToYoungMap(View& view);
  void AddKeyframe(const FacedPoints& points);
  Alignment AlignUnlessOverruled(const FacedPoints& points, const Pose2& T_map_guess,
                                 const Eigen::Matrix3d& prior_information) const;
  Alignment AlignFromSeveralGuesses(const FacedPoints& points, const Pose2& T_map_guess,
                                    const Eigen::Matrix3d& prior_information) const;

  ScanOdometryOptions options_;
  Path path_;
  Maps maps_;
  double reach_m_ = std::numeric_limits<double>::infinity();
  double suspected_m_ = 0.0;  ///< travel through which the scene may become another one
  int rest_scans_ = 0;        ///< matched since the robot came to rest
  int lost_ = 0;              ///< scans in a row that were not believed
  double heading_sigma_rad_ = std::numeric_limits<double>::infinity();
  double inlier_share_ = 1.0;
  Eigen::Matrix2d seen_of_step_ = Eigen::Matrix2d::Zero();
};

}  // namespace masked_mapper
