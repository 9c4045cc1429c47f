// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/log_survey.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "masked_mapper/log/input_error.hpp"
#include "masked_mapper/log/log_reader.hpp"

namespace masked_mapper {
namespace {

double Median(std::vector<float> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LogSurvey SurveyLog(const std::string& path, const Options& options) {
  LogOptions log_options = options.log;
  log_options.read_ranges = false;
  const std::unique_ptr<LogReader> log = OpenLog(path, log_options);
  LogSurvey survey;
  FloorTracker floors(options.floors);
  std::optional<Pose2> T_odom_before;
  std::optional<double> stamp_before;
  std::vector<float> travels;
  std::vector<float> turns;
  std::vector<float> periods;
  while (const std::optional<Observation> observation = log->Next()) {
    floors.Observe(*observation);
    if (std::holds_alternative<OdometryReading>(*observation)) survey.has_odometry = true;
    const auto* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr) continue;
    ++survey.scans;
    if (stamp_before) periods.push_back(static_cast<float>(scan->stamp - *stamp_before));
    stamp_before = scan->stamp;
    if (!scan->T_odom_robot) continue;
    survey.has_odometry = true;
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
  if (floors.NeedsRanges()) {
    const std::unique_ptr<LogReader> again = OpenLog(path, options.log);
    while (const std::optional<Observation> observation = again->Next()) {
      floors.Observe(*observation);
    }
  }
  survey.floors = floors.Finish();
  survey.floor_source = floors.source();
  survey.warnings = floors.warnings();
  survey.median_travel_m = Median(std::move(travels));
  survey.median_turn_rad = Median(std::move(turns));
  survey.median_period_s = Median(std::move(periods));
  return survey;
}

MotionSource SettleMotionSource(const std::string& path, MotionSource requested,
                                const LogSurvey& survey) {
  if (requested == MotionSource::kOdometry && !survey.has_odometry) {
    throw InputError(path + ": motion.source is `odometry`, but the log has no odometry");
  }
  if (requested != MotionSource::kAuto) return requested;
  if (!survey.has_odometry) return MotionSource::kScans;
  // Ours: a scan half a metre or 15 degrees from the one before still shares most of its view with
  // it, and wheels guess such a step well enough.
  const bool often_enough =
      survey.median_travel_m <= 0.5 && survey.median_turn_rad <= DegToRad(15.0);
  return often_enough ? MotionSource::kFused : MotionSource::kOdometry;
}

}  // namespace masked_mapper
