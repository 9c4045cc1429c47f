// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/drive_motion.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"

namespace masked_mapper {
namespace {

MappingOptions Fused() {
  MappingOptions options;
  options.motion.source = MotionSource::kFused;
  return options;
}

TEST(DriveMotion, IsTheMotionOfScansWhereNothingRides) {
  const RingDrive drive(0.6, 0.3);
  const FloorTimeline floors;
  const MotionOptions options = Fused().motion;
  DriveMotion motion(options, 3.0, floors);
  MotionEstimator estimator(options);
  EXPECT_FALSE(motion.Observe(OdometryReading{0.0, {}}));
  EXPECT_FALSE(motion.Observe(PressureReading{}));
  estimator.Observe(OdometryReading{0.0, {}});
  UncertainPose2 T_start_robot;
  for (const LaserScan& scan : drive.scans) {
    const std::optional<MovedScan> moved = motion.Observe(scan);
    estimator.Observe(scan);
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->scan.ranges, scan.ranges);
    EXPECT_EQ(moved->T_odom_robot.AsVector(), estimator.T_odom_robot().AsVector());
    T_start_robot = T_start_robot * moved->T_last_robot;
    EXPECT_EQ(T_start_robot.mean.AsVector(), estimator.T_node_robot().mean.AsVector());
    EXPECT_EQ(T_start_robot.covariance, estimator.T_node_robot().covariance);
  }
  EXPECT_GT(motion.seconds(), 0.0);
}

// A cab's door opens on another scene, and the motion begins its local map anew; on stairs it goes
// on.
TEST(DriveMotion, ACabIsATransitAndStairsAreNone) {
  const RingDrive drive(1.0, 0.3);
  const MotionOptions options = Fused().motion;
  FloorTimeline floors;
  floors.levels.resize(2);
  const std::size_t out = drive.scans.size() / 3;
  const std::size_t in = out + 20;
  floors.intervals.push_back({drive.scans[out].stamp, 0, true});
  floors.intervals.push_back({drive.scans[in].stamp, 1, false});
  for (const bool by_cab : {true, false}) {
    for (FloorInterval& interval : floors.intervals) interval.travelled_m = by_cab ? 2.0 : 5.0;
    DriveMotion motion(options, 3.0, floors);
    MotionEstimator estimator(options);
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      const std::optional<MovedScan> moved = motion.Observe(drive.scans[i]);
      estimator.Observe(drive.scans[i], i == out || i == in);
      if (by_cab && i == out) estimator.EnterTransit();
      if (by_cab && i == in) estimator.LeaveTransit();
      ASSERT_TRUE(moved);
      EXPECT_EQ(moved->interval.level, i < in ? 0U : 1U);
      EXPECT_EQ(moved->interval.in_transit, i >= out && i < in);
      ASSERT_EQ(moved->T_odom_robot.AsVector(), estimator.T_odom_robot().AsVector())
          << by_cab << " " << i;
    }
  }
}

// What makes it fit to run ahead of the map: closures leave no trace in it.
TEST(DriveMotion, ClosuresChangeNothingOfIt) {
  const RingDrive drive(1.3, 0.3);
  const FloorTimeline floors;
  MaskedMapper mapper("always", Fused(), floors);
  DriveMotion alone(Fused().motion, Fused().nodes.cab_m, floors);
  std::vector<Pose2> T_odom_robot;
  for (const LaserScan& scan : drive.scans) {
    mapper.Observe(scan);
    T_odom_robot.push_back(alone.Observe(scan)->T_odom_robot);
  }
  const BuildingMap& map = mapper.result();
  EXPECT_GT(map.graph.edges().size(), map.graph.nodes().size()) << "or the test shows nothing";
  for (std::size_t i = 0; i < T_odom_robot.size(); ++i) {
    EXPECT_EQ(map.trajectory[i].T_odom_robot.AsVector(), T_odom_robot[i].AsVector());
  }
}

TEST(DriveMotion, ItsStateComesBack) {
  const RingDrive drive(0.6, 0.3);
  FloorTimeline floors;
  floors.intervals.push_back({drive.scans[30].stamp, 0, true});
  floors.intervals.push_back({drive.scans[60].stamp, 0, false});
  for (const std::size_t broken : {std::size_t{1}, std::size_t{40}, std::size_t{100}}) {
    DriveMotion whole(Fused().motion, 3.0, floors);
    DriveMotion second(Fused().motion, 3.0, floors);
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      if (i == broken) second.RestoreState(whole.SaveState());
      const std::optional<MovedScan> moved = whole.Observe(drive.scans[i]);
      if (i < broken) continue;
      EXPECT_EQ(second.Observe(drive.scans[i])->T_odom_robot.AsVector(),
                moved->T_odom_robot.AsVector());
    }
  }
}

}  // namespace
}  // namespace masked_mapper
