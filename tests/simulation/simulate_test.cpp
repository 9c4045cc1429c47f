// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulate.hpp"

#include <gtest/gtest.h>

#include <map>

#include "masked_mapper/text/input_error.hpp"
#include "simulation/building_plans.hpp"

namespace masked_mapper {
namespace {

struct Recorded {
  std::vector<Observation> observations;
  std::vector<TruthPose> truth;
  SimulationSummary summary;

  std::vector<LaserScan> Scans() const {
    std::vector<LaserScan> scans;
    for (const Observation& observation : observations) {
      if (const auto* scan = std::get_if<LaserScan>(&observation)) scans.push_back(*scan);
    }
    return scans;
  }
};

Recorded Record(const Building& building, const SimulationOptions& options,
                const SimulationNoise& noise) {
  Recorded recorded;
  SimulationSink sink;
  sink.observation = [&](const Observation& o) { recorded.observations.push_back(o); };
  sink.truth = [&](const TruthPose& pose) { recorded.truth.push_back(pose); };
  recorded.summary = Simulate(building, options, noise, sink);
  return recorded;
}

TEST(Simulate, SameSeedSameObservations) {
  SimulationOptions options;
  options.seed = 5;
  const Recorded a = Record(OfficeBuilding(), options, {});
  const Recorded b = Record(OfficeBuilding(), options, {});
  options.seed = 6;
  const Recorded c = Record(OfficeBuilding(), options, {});
  ASSERT_EQ(a.observations.size(), b.observations.size());
  const std::vector<LaserScan> scans_a = a.Scans();
  const std::vector<LaserScan> scans_b = b.Scans();
  for (std::size_t i = 0; i < scans_a.size(); ++i) {
    EXPECT_EQ(scans_a[i].stamp, scans_b[i].stamp);
    EXPECT_EQ(scans_a[i].ranges, scans_b[i].ranges);
    EXPECT_EQ(scans_a[i].T_odom_robot->AsVector(), scans_b[i].T_odom_robot->AsVector());
  }
  EXPECT_NE(scans_a[0].ranges, c.Scans()[0].ranges);
}

TEST(Simulate, APerfectWorldIsPerfect) {
  const Recorded recorded = Record(OfficeBuilding(), {}, SimulationNoise::None());
  const std::vector<LaserScan> scans = recorded.Scans();
  ASSERT_EQ(scans.size(), recorded.truth.size());
  ASSERT_EQ(scans.size(), recorded.summary.scans);
  EXPECT_EQ(recorded.truth[0].T_world_robot.AsVector(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    ASSERT_EQ(scans[i].stamp, recorded.truth[i].stamp);
    ASSERT_NEAR(Distance(*scans[i].T_odom_robot, recorded.truth[i].T_world_robot), 0.0, 1e-6)
        << "m";
  }
}

TEST(Simulate, ObservationsComeInOrderAndAtTheirRates) {
  SimulationOptions options;
  options.acceleration.rate = 20.0;
  options.floor_labels = true;
  const Recorded recorded = Record(OfficeBuilding(), options, {});
  double last = 0.0;
  std::map<std::size_t, double> counts;
  std::vector<std::string> labels;
  for (const Observation& observation : recorded.observations) {
    EXPECT_GE(Stamp(observation), last);
    last = Stamp(observation);
    ++counts[observation.index()];
    if (const auto* floor = std::get_if<FloorLabel>(&observation)) labels.push_back(floor->label);
  }
  const double seconds = recorded.summary.seconds;
  EXPECT_NEAR(counts[0] / seconds, 5.0, 0.1) << "Hz, between scans";
  EXPECT_NEAR(counts[1] / seconds, 5.0, 0.1) << "Hz";
  EXPECT_NEAR(counts[2] / seconds, 2.0, 0.1) << "Hz";
  EXPECT_NEAR(counts[3] / seconds, 20.0, 0.1) << "Hz";
  EXPECT_EQ(labels, (std::vector<std::string>{"0", "-", "1", "-", "0"}));
  EXPECT_EQ(recorded.summary.floor_changes, 2U);
}

TEST(Simulate, TruthKnowsTheFloors) {
  const Recorded recorded = Record(TowerBuilding(), {}, SimulationNoise::None());
  std::map<std::string, int> scans;
  for (const TruthPose& pose : recorded.truth) {
    ++scans[pose.floor];
    if (pose.floor != "-") {
      EXPECT_NEAR(pose.elevation, 3.6 * std::stod(pose.floor), 1e-9) << "m";
    }
  }
  EXPECT_EQ(scans.size(), 11U);
}

TEST(Simulate, NoFloorLabelsUnlessAsked) {
  const Recorded recorded = Record(OfficeBuilding(), {}, {});
  for (const Observation& observation : recorded.observations) {
    EXPECT_FALSE(std::holds_alternative<FloorLabel>(observation));
    EXPECT_FALSE(std::holds_alternative<AccelerationReading>(observation));
  }
}

TEST(Simulate, RefusesNonsense) {
  SimulationOptions options;
  options.length = -1.0;
  EXPECT_THROW(Simulate(OfficeBuilding(), options, {}, {}), InputError);
  options = {};
  options.pressure.rate = 1e9;
  EXPECT_THROW(Simulate(OfficeBuilding(), options, {}, {}), InputError);
  EXPECT_THROW(Simulate(Building(), {}, {}, {}), InputError);
}

}  // namespace
}  // namespace masked_mapper
