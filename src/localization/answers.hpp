// SPDX-License-Identifier: BSD-3-Clause
// What was answered to each scan, and the spans in which the answer was not sure.
#pragma once

#include <string>

#include "hypotheses.hpp"
#include "masked_mapper/localization/localizer.hpp"

namespace masked_mapper {

/// Of a place that was found, so that what lies three sigmas away is another one.
UncertainPose2 Found(const Pose2& T_world_robot);

class Answers {
 public:
  const Localization& result() const { return result_; }
  Localization& result() { return result_; }

  bool empty() const { return result_.scans.empty(); }
  /// Of the last scan.
  std::size_t Last() const { return result_.scans.size() - 1; }
  double LastStamp() const { return result_.scans.back().stamp; }
  bool IsSure() const { return !empty() && result_.scans.back().sure; }

  /// A scan that is not answered yet.
  void Add(const LaserScan& scan, const Pose2& T_odom_robot);

  /// The last scan is there, after so much way; sure where the pose is known well enough.
  void Place(FloorId floor, const UncertainPose2& T_world_robot, double travelled_m);
  /// The last scan as it stands, unless it was placed and is sure: `why_not`, for people.
  void Close(const std::string& why_not);

  /// Scans from before a place was found.
  void PlaceInHindsight(const Hypothesis& found);

 private:
  Localization result_;
};

}  // namespace masked_mapper
