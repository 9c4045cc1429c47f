// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/checkpoint.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mapping/masked_mapper.hpp"
#include "mapping/ring_drive.hpp"
#include "mapping/same_map.hpp"
#include "masked_mapper/sensor/state_archive.hpp"

namespace masked_mapper {
namespace {

/// Two floors, a ride between them and back.
FloorTimeline TwoFloors(const RingDrive& drive) {
  const auto stamp = [&](double share) {
    return drive.scans[static_cast<std::size_t>(share * static_cast<double>(drive.scans.size()))]
        .stamp;
  };
  FloorTimeline floors;
  floors.levels.push_back({"up", 3.0, 0.1, true, true, ""});
  floors.intervals.push_back({stamp(0.40), 0, true});
  floors.intervals.push_back({stamp(0.42), 1, true});
  floors.intervals.push_back({stamp(0.45), 1, false});
  for (FloorInterval& interval : floors.intervals) interval.travelled_m = 5.0;  // stairs
  floors.intervals.push_back({stamp(0.70), 0, false});  // without a word of the ride
  return floors;
}

MappingOptions OptionsFor(MotionSource source) {
  MappingOptions options;
  options.motion.source = source;
  return options;
}

/// What a store would keep and give back.
Checkpoint Kept(MaskedMapper& mapper) {
  Checkpoint checkpoint;
  checkpoint.state.bytes = mapper.SaveState();
  // In two pieces, as they grow.
  const BuildingMap& map = mapper.result();
  std::vector<TrajectoryPose> poses = map.trajectory;
  std::vector<KeptScan> scans = map.kept_scans;
  poses.resize(poses.size() / 2);
  scans.resize(scans.size() / 2);
  AppendPoses(PackPoses(poses, 0), checkpoint.parts);
  AppendPoses(PackPoses(map.trajectory, poses.size()), checkpoint.parts);
  AppendScans(PackScans(scans, 0), checkpoint.parts);
  AppendScans(PackScans(map.kept_scans, scans.size()), checkpoint.parts);
  return checkpoint;
}

BuildingMap Unbroken(const RingDrive& drive, const std::string& mask, const MappingOptions& options,
                     const FloorTimeline& floors) {
  MaskedMapper mapper(mask, options, floors);
  for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
  return mapper.Finish();
}

/// The same, but at each of `breaks` all is put away and taken up by another mapper.
BuildingMap Broken(const RingDrive& drive, const std::string& mask, const MappingOptions& options,
                   const FloorTimeline& floors, const std::vector<std::size_t>& breaks) {
  auto mapper = std::make_unique<MaskedMapper>(mask, options, floors);
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    if (std::find(breaks.begin(), breaks.end(), i) != breaks.end()) {
      Checkpoint checkpoint = Kept(*mapper);
      mapper = std::make_unique<MaskedMapper>(mask, options, floors);
      mapper->RestoreState(checkpoint.state.bytes, std::move(checkpoint.parts));
      for (std::size_t j = 0; j < i; ++j) mapper->RememberScan(drive.scans[j]);
    }
    mapper->Observe(drive.scans[i]);
  }
  return mapper->Finish();
}

TEST(Checkpoint, ABrokenDriveEndsWithTheSameMap) {
  const RingDrive drive(1.7, 0.3);
  const std::size_t n = drive.scans.size();
  const FloorTimeline one_floor;
  const FloorTimeline two_floors = TwoFloors(drive);
  const struct {
    const char* mask;
    MotionSource source;
    const FloorTimeline& floors;
  } drives[] = {
      {"openings", MotionSource::kFused, two_floors},
      {"any(openings,eccentricity)", MotionSource::kScans, one_floor},
      {"always", MotionSource::kOdometry, two_floors},
      {"not(openings)", MotionSource::kFused, one_floor},
      {"sparse(always)", MotionSource::kFused, two_floors},
      {"never", MotionSource::kOdometry, one_floor},
  };
  for (const auto& one : drives) {
    const MappingOptions options = OptionsFor(one.source);
    const BuildingMap whole = Unbroken(drive, one.mask, options, one.floors);
    const BuildingMap broken =
        Broken(drive, one.mask, options, one.floors,
               {1, 2, n / 5, 2 * n / 5, 41 * n / 100, 43 * n / 100, 46 * n / 100, n / 2, 7 * n / 10,
                7 * n / 10 + 1, 4 * n / 5, n - 1});
    EXPECT_TRUE(SameMap(whole, broken)) << one.mask;
    if (std::string(one.mask) != "never") {
      EXPECT_GE(whole.closures.size(), 2U) << one.mask;
    }
  }
}

TEST(Checkpoint, ABrokenDriveOfBentScansEndsWithTheSameMap) {
  RingDrive drive(1.2, 0.3);
  for (LaserScan& scan : drive.scans) scan.beam_time = 1e-4;
  const std::size_t n = drive.scans.size();
  const MappingOptions options = OptionsFor(MotionSource::kScans);
  const BuildingMap whole = Unbroken(drive, "openings", options, {});
  EXPECT_TRUE(SameMap(whole, Broken(drive, "openings", options, {}, {n / 5, n / 2})));
  for (const KeptScan& kept : whole.kept_scans) EXPECT_EQ(kept.scan.beam_time, 0.0);
}

TEST(Checkpoint, BeforeTheFirstScanIsACheckpointToo) {
  const RingDrive drive(0.3, 0.3);
  const MappingOptions options = OptionsFor(MotionSource::kFused);
  EXPECT_TRUE(SameMap(Unbroken(drive, "openings", options, {}),
                      Broken(drive, "openings", options, {}, {0})));
}

TEST(Checkpoint, DamageIsRefusedOrHarmless) {
  const RingDrive drive(0.6, 0.3);
  const MappingOptions options = OptionsFor(MotionSource::kFused);
  const FloorTimeline floors;
  MaskedMapper mapper("openings", options, floors);
  for (const LaserScan& scan : drive.scans) mapper.Observe(scan);
  const Checkpoint kept = Kept(mapper);
  std::mt19937 random(1);
  const auto restore = [&](const std::string& bytes) {
    MaskedMapper other("openings", options, floors);
    other.RestoreState(bytes, kept.parts);
  };
  restore(kept.state.bytes);
  for (int i = 0; i < 50; ++i) {
    EXPECT_THROW(restore(kept.state.bytes.substr(0, random() % kept.state.bytes.size())),
                 StateError);
  }
  EXPECT_THROW(restore(kept.state.bytes + "x"), StateError);
  // Sizes that promise the sky must not be believed.
  for (int i = 0; i < 200; ++i) {
    std::string bytes = kept.state.bytes;
    const std::size_t place = random() % (bytes.size() - 8);
    bytes.replace(place, 8, 8, '\xff');
    try {
      restore(bytes);
    } catch (const StateError&) {
    }
  }
}

TEST(Checkpoint, ASurveyComesBack) {
  LogSurvey survey;
  survey.scans = 7;
  survey.has_odometry = true;
  survey.odometry_moves = true;
  survey.median_period_s = 0.2;
  survey.sweep_s_per_rad = -0.03;
  survey.floors.levels.push_back({"up", 3.5, 0.1, true, false, "it fits two"});
  survey.floors.intervals.push_back({12.5, 1, true});
  survey.floors.heard = {{-1.0, 3.5}, {8.0, 9.0}};
  survey.floors.joined = true;
  survey.floor_source = FloorSource::kPressure;
  survey.warnings = {"a", ""};
  const LogSurvey back = UnpackSurvey(PackSurvey(survey));
  EXPECT_EQ(back.scans, 7U);
  EXPECT_TRUE(back.has_odometry);
  EXPECT_TRUE(back.odometry_moves);
  EXPECT_EQ(back.median_period_s, 0.2);
  EXPECT_EQ(back.sweep_s_per_rad, -0.03);
  ASSERT_EQ(back.floors.levels.size(), 2U);
  EXPECT_EQ(back.floors.levels[1].label, "up");
  EXPECT_FALSE(back.floors.levels[1].identity_known);
  EXPECT_EQ(back.floors.levels[1].open, "it fits two");
  EXPECT_EQ(back.floors.intervals[1].start, 12.5);
  ASSERT_EQ(back.floors.heard.size(), 2U);
  EXPECT_EQ(back.floors.heard[1].end, 9.0);
  EXPECT_TRUE(back.floors.joined);
  EXPECT_EQ(back.floor_source, FloorSource::kPressure);
  EXPECT_EQ(back.warnings, survey.warnings);
  survey.floors.intervals[1].level = 2;
  EXPECT_THROW(UnpackSurvey(PackSurvey(survey)), StateError);
  EXPECT_THROW(UnpackSurvey(""), StateError);
}

}  // namespace
}  // namespace masked_mapper
