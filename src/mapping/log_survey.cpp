// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/log_survey.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "masked_mapper/geometry/median.hpp"
#include "masked_mapper/log/floor_file.hpp"
#include "masked_mapper/motion/floor_tracker.hpp"
#include "masked_mapper/motion/sweep_check.hpp"
#include "masked_mapper/motion/wheel_check.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "unbroken_way.hpp"
#include "wheel_mending.hpp"
#include "work_behind.hpp"

namespace masked_mapper {
namespace {

constexpr int kMostRounds = 3;  // of mending; what is still found then is left to the map

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

std::vector<TimeSpan> SpansOf(const std::vector<FalseRest>& rests) {
  std::vector<TimeSpan> spans;
  for (const FalseRest& rest : rests) spans.push_back(rest.span);
  return spans;
}

/// Observations for several, each of which works through them in a thread of its own. They are
/// handed over many at once, since it takes time to wake a thread.
class Listeners {
 public:
  explicit Listeners(bool in_threads) : in_threads_(in_threads) {}

  template <typename Check>
  void Add(Check* check) {
    const auto observe = [check](const Observation& observation) {
      if (const auto* reading = std::get_if<OdometryReading>(&observation))
        check->Observe(*reading);
      if (const auto* scan = std::get_if<LaserScan>(&observation)) check->Observe(*scan);
    };
    behind_.push_back(std::make_unique<WorkBehind<Batch>>(
        kMostWaiting, in_threads_, [observe](const Batch& batch) {
          for (const Observation& observation : *batch) observe(observation);
        }));
  }

  void Observe(Observation observation) {
    if (!batch_) batch_ = std::make_shared<std::vector<Observation>>();
    batch_->push_back(std::move(observation));
    if (!in_threads_ || batch_->size() == kHandedOver) HandOver();
  }

  /// Waits until all have heard all. Throws what they threw.
  void Finish() {
    HandOver();
    for (const auto& listener : behind_) listener->Finish();
  }

 private:
  using Batch = std::shared_ptr<std::vector<Observation>>;
  static constexpr std::size_t kHandedOver = 64;
  static constexpr std::size_t kMostWaiting = 32;

  void HandOver() {
    if (!batch_) return;
    for (const auto& listener : behind_) listener->Add(batch_);
    batch_.reset();
  }

  bool in_threads_;
  Batch batch_;
  std::vector<std::unique_ptr<WorkBehind<Batch>>> behind_;
};

/// One pass through the log, scans with their beams: all that is to be known of it before it is
/// mapped.
class Surveyor {
 public:
  /// `mending` is that of the log which will be observed.
  Surveyor(const MappingOptions& options, const std::vector<FloorLabel>& labels,
           const OdometryMending& mending)
      : floors_(options.floors),
        standstill_(options.motion),
        wheels_(options.motion),
        sweep_(options.motion),
        unbroken_(options.motion, !mending.left_out.empty()),
        turns_left_out_(mending.turns_left_out),
        motion_source_(options.motion.source),
        threads_(options.threads),
        listeners_(options.threads > 1) {
    if (!options.floors.file.empty()) floors_.UseLabels(labels);
    if (motion_source_ != MotionSource::kScans) listeners_.Add(&standstill_);
    listeners_.Add(&wheels_);
  }

  void Observe(Observation observation) {
    unbroken_.Follow(observation, [&](const Observation& followed) { floors_.Observe(followed); });
    if (const auto* reading = std::get_if<OdometryReading>(&observation)) {
      NoteWay(*reading);
      listeners_.Observe(*reading);
    }
    if (auto* scan = std::get_if<LaserScan>(&observation)) ObserveScan(std::move(*scan));
  }

  /// Behind the last observation.
  void EndPass() {
    listeners_.Finish();
    // What scans say of their sweep is worked out beside what they say of the wheels.
    sweep_found_ = std::async(threads_ > 1 ? std::launch::async : std::launch::deferred,
                              [this] { return sweep_.Find(threads_); });
  }

  /// What is to be mended of the wheels, each with its finding.
  WheelMending Wheels() {
    if (!AsksWheels() || !survey_.odometry_moves) return {};
    if (turns_left_out_) {
      // Of the turns no more is to be asked: where the robot turns on its place, such wheels rest.
      WheelReport report = wheels_.Find({});
      report.fault.scan_clock_s.reset();
      report.fault.turn_factor.reset();
      report.fault.turns_useless = false;
      return MendingOf(report.fault, {}, log_);
    }
    // With another clock wheels seem to stand still where they do not.
    const std::vector<FalseRest> rests = standstill_.Find();
    if (!rests.empty()) {
      const WheelReport of_all = wheels_.Find({});
      if (of_all.fault.scan_clock_s) return MendingOf(of_all.fault, rests, log_);
    }
    return MendingOf(WhereWheelsTurn().fault, rests, log_);
  }

  /// Behind the last observation.
  const std::vector<UnbrokenWay::Silence>& silences() const { return unbroken_.silences(); }

  LogSurvey Finish() {
    survey_.floors = floors_.Finish();
    NoteTravel(way_, survey_.floors);
    survey_.floor_source = floors_.source();
    survey_.warnings = floors_.warnings();
    if (survey_.odometry_moves && !turns_left_out_) {
      const std::string fault =
          WarningOf(FindMountFault(WhereWheelsTurn().stretches), T_robot_laser_);
      if (!fault.empty()) survey_.warnings.push_back(fault);
    } else if (survey_.has_odometry && !survey_.odometry_moves) {
      survey_.warnings.emplace_back("the odometry never moves: scans alone tell the motion");
    }
    if (motion_source_ == MotionSource::kOdometry && survey_.odometry_moves) {
      for (const FalseRest& rest : standstill_.Find()) {
        survey_.warnings.push_back(InWords(rest) +
                                   "; the map has only the way by odometry, as motion.source says");
      }
    }
    SettleSweep();
    survey_.median_travel_m = Median(std::move(travels_));
    survey_.median_turn_rad = Median(std::move(turns_));
    survey_.median_period_s = Median(std::move(periods_));
    return std::move(survey_);
  }

 private:
  /// Not where the user settled whom to believe.
  bool AsksWheels() const {
    return motion_source_ == MotionSource::kAuto || motion_source_ == MotionSource::kFused;
  }

  /// Of the wheels without the rests that are none; behind the last observation.
  const WheelReport& WhereWheelsTurn() {
    if (!report_) report_ = wheels_.Find(SpansOf(standstill_.Find()));
    return *report_;
  }

  void ObserveScan(LaserScan scan) {
    if (survey_.scans++ == 0) {
      log_.start = scan.stamp;
      T_robot_laser_ = scan.T_robot_laser;
    }
    log_.end = scan.stamp;
    sweep_.Observe(scan);
    if (stamp_before_) periods_.push_back(static_cast<float>(scan.stamp - *stamp_before_));
    stamp_before_ = scan.stamp;
    if (scan.T_odom_robot) NoteStep(scan.stamp, *scan.T_odom_robot);
    if (scan.beam_time != 0.0) scan = Timed(scan, sweep_.Stated());
    listeners_.Observe(std::move(scan));
  }

  /// From scan to scan.
  void NoteStep(double stamp, const Pose2& T_odom_robot) {
    NoteWay({stamp, T_odom_robot});
    if (T_odom_before_) {
      const Pose2 step = Between(*T_odom_before_, T_odom_robot);
      const double travel = std::hypot(step.x, step.y);
      if (travel > 0.01 || std::abs(step.theta) > 0.01) {
        travels_.push_back(static_cast<float>(travel));
        turns_.push_back(static_cast<float>(std::abs(step.theta)));
      }
    }
    T_odom_before_ = T_odom_robot;
  }

  void SettleSweep() {
    SweepCheck::Verdict sweep = sweep_found_.get();
    survey_.sweep_s_per_rad = sweep.seconds_per_rad;
    if (sweep.finding) survey_.findings.push_back(std::move(*sweep.finding));
  }

  void NoteWay(const OdometryReading& reading) {
    const double step = T_odom_noted_ ? Distance(*T_odom_noted_, reading.T_odom_robot) : 0.0;
    survey_.has_odometry = true;
    survey_.odometry_moves |=
        T_odom_noted_ && T_odom_noted_->AsVector() != reading.T_odom_robot.AsVector();
    way_.push_back({reading.stamp, (way_.empty() ? 0.0 : way_.back().travelled_m) + step});
    T_odom_noted_ = reading.T_odom_robot;
  }

  LogSurvey survey_;
  FloorTracker floors_;
  StandstillCheck standstill_;
  WheelCheck wheels_;
  std::optional<WheelReport> report_;  ///< once it was asked for
  SweepCheck sweep_;
  UnbrokenWay unbroken_;
  bool turns_left_out_;
  MotionSource motion_source_;  ///< as the user wants it
  Pose2 T_robot_laser_;
  TimeSpan log_;                        ///< from the first scan to the last
  std::optional<double> stamp_before_;  ///< of the scan before, as all below
  std::optional<Pose2> T_odom_before_;
  std::optional<Pose2> T_odom_noted_;
  std::vector<TravelledWay> way_;
  std::vector<float> travels_;  ///< m, from scan to scan
  std::vector<float> turns_;    ///< rad
  std::vector<float> periods_;  ///< s
  int threads_;
  // The last, since their threads use the others.
  std::future<SweepCheck::Verdict> sweep_found_;
  Listeners listeners_;
};

}  // namespace

LogSurvey SurveyLog(LogSource& source, const MappingOptions& options) {
  std::vector<FloorLabel> labels;
  if (!options.floors.file.empty()) labels = ReadFloorFile(options.floors.file);
  bool reconsidered = false;
  WheelMending wheels;
  int rounds = 0;
  while (true) {
    const std::unique_ptr<LogReader> log = source.Read();
    Surveyor surveyor(options, labels, wheels.mending);
    while (std::optional<Observation> observation = log->Next()) {
      surveyor.Observe(std::move(*observation));
    }
    surveyor.EndPass();
    if (source.Reconsider()) {
      reconsidered = true;
      continue;
    }
    const WheelMending more = surveyor.Wheels();
    if (!more.mending.IsNone() && rounds++ < kMostRounds) {
      Add(more, &wheels);
      source.Mend(wheels.mending);
      continue;
    }
    LogSurvey survey = surveyor.Finish();
    if (survey.scans == 0) throw InputError(source.path() + ": not one valid laser scan in it");
    if (!labels.empty()) CheckClock(options.floors.file, labels, log->Statistics());
    survey.reconsidered = reconsidered;
    survey.mending = wheels.mending;
    const std::vector<SensorFinding> of_the_source = source.Findings();
    survey.findings.insert(survey.findings.begin(), of_the_source.begin(), of_the_source.end());
    survey.findings.insert(survey.findings.end(), wheels.findings.begin(), wheels.findings.end());
    AddSilences(surveyor.silences(), wheels.mending, &survey.findings);
    return survey;
  }
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
