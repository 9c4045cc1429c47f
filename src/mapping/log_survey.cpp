// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/log_survey.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "masked_mapper/geometry/median.hpp"
#include "masked_mapper/log/floor_file.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/motion/mount_check.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

/// One label may stand for the whole log; of several, none in the log's time means another clock.
void CheckClock(const std::string& path, const std::vector<FloorLabel>& labels,
                const LogStatistics& log) {
  const bool is_in_time = std::any_of(labels.begin(), labels.end(), [&](const FloorLabel& label) {
    return label.stamp >= log.first_stamp && label.stamp <= log.last_stamp;
  });
  if (is_in_time || labels.size() <= 1) return;
  throw InputError(path + ": no label falls into the time of the log, which is " +
                   FixedText(log.first_stamp, 3) + " to " + FixedText(log.last_stamp, 3) + " s");
}

/// Looks at the first turns of the drive once more, with beams.
std::string FaultOfMount(const std::string& path, const MappingOptions& options) {
  MountCheck check(options.motion);
  const std::unique_ptr<LogReader> log = OpenLog(path, options.log);
  while (!check.IsSettled()) {
    const std::optional<Observation> observation = log->Next();
    if (!observation) break;
    if (const auto* scan = std::get_if<LaserScan>(&*observation)) check.Observe(*scan);
  }
  return check.Warning();
}

}  // namespace

LogSurvey SurveyLog(const std::string& path, const MappingOptions& options) {
  LogOptions log_options = options.log;
  log_options.read_ranges = false;
  FloorTracker floors(options.floors);
  std::vector<FloorLabel> labels;
  if (!options.floors.file.empty()) {
    labels = ReadFloorFile(options.floors.file);
    floors.UseLabels(labels);
  }
  const std::unique_ptr<LogReader> log = OpenLog(path, log_options);
  LogSurvey survey;
  std::optional<Pose2> T_odom_before;
  std::optional<double> stamp_before;
  std::vector<TravelledWay> way;
  std::vector<float> travels;
  std::vector<float> turns;
  std::vector<float> periods;
  std::optional<Pose2> T_odom_noted;
  const auto note_way = [&](const OdometryReading& reading) {
    const double step = T_odom_noted ? Distance(*T_odom_noted, reading.T_odom_robot) : 0.0;
    survey.has_odometry = true;
    survey.odometry_moves |=
        T_odom_noted && T_odom_noted->AsVector() != reading.T_odom_robot.AsVector();
    way.push_back({reading.stamp, (way.empty() ? 0.0 : way.back().travelled_m) + step});
    T_odom_noted = reading.T_odom_robot;
  };
  while (const std::optional<Observation> observation = log->Next()) {
    floors.Observe(*observation);
    if (const auto* reading = std::get_if<OdometryReading>(&*observation)) note_way(*reading);
    const auto* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr) continue;
    ++survey.scans;
    if (stamp_before) periods.push_back(static_cast<float>(scan->stamp - *stamp_before));
    stamp_before = scan->stamp;
    if (!scan->T_odom_robot) continue;
    note_way({scan->stamp, *scan->T_odom_robot});
    if (T_odom_before) {
      const Pose2 step = Between(*T_odom_before, *scan->T_odom_robot);
      const double travel = std::hypot(step.x, step.y);
      if (travel > 0.01 || std::abs(step.theta) > 0.01) {
        travels.push_back(static_cast<float>(travel));
        turns.push_back(static_cast<float>(std::abs(step.theta)));
      }
    }
    T_odom_before = scan->T_odom_robot;
  }
  if (survey.scans == 0) throw InputError(path + ": not one valid laser scan in it");
  if (!labels.empty()) CheckClock(options.floors.file, labels, log->Statistics());
  if (floors.NeedsRanges()) {
    const std::unique_ptr<LogReader> again = OpenLog(path, options.log);
    while (const std::optional<Observation> observation = again->Next()) {
      floors.ObserveRanges(*observation);
    }
  }
  survey.floors = floors.Finish();
  NoteTravel(way, survey.floors);
  survey.floor_source = floors.source();
  survey.warnings = floors.warnings();
  if (survey.odometry_moves) {
    const std::string fault = FaultOfMount(path, options);
    if (!fault.empty()) survey.warnings.push_back(fault);
  } else if (survey.has_odometry) {
    survey.warnings.emplace_back("the odometry never moves: scans alone tell the motion");
  }
  survey.median_travel_m = Median(std::move(travels));
  survey.median_turn_rad = Median(std::move(turns));
  survey.median_period_s = Median(std::move(periods));
  return survey;
}

MotionSource SettleMotionSource(const std::string& path, const MotionOptions& options,
                                const LogSurvey& survey) {
  if (options.source == MotionSource::kOdometry && !survey.has_odometry) {
    throw InputError(path + ": motion.source is `odometry`, but the log has no odometry");
  }
  if (options.source != MotionSource::kAuto) return options.source;
  if (!survey.odometry_moves) return MotionSource::kScans;
  // Measured on real logs thinned to one scan in 1 to 2 s: as long as neighbouring scans share some
  // of their view, correcting the wheels by them was better on every one.
  const bool often_enough = survey.median_travel_m <= options.longest_step_m &&
                            survey.median_turn_rad <= DegToRad(options.longest_turn_deg);
  return often_enough ? MotionSource::kFused : MotionSource::kOdometry;
}

}  // namespace masked_mapper
