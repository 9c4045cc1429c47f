// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/map_log.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

#include "clouds_at_poses.hpp"
#include "masked_mapper.hpp"
#include "masked_mapper/doubt/doubt.hpp"
#include "masked_mapper/joining/floor_joining.hpp"
#include "masked_mapper/log/log_summary.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/mapping/log_survey.hpp"
#include "masked_mapper/sensor/state_archive.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "moved_scans.hpp"
#include "wheels_by_closures.hpp"

namespace masked_mapper {
namespace {

// Asked once, where the level was first reached.
std::string OpenQuestion(const FloorTimeline& floors, const FloorChange& change) {
  const auto first = std::find_if(floors.intervals.begin(), floors.intervals.end(),
                                  [&](const FloorInterval& interval) {
                                    return !interval.in_transit && interval.level == change.to;
                                  });
  const bool is_first = first != floors.intervals.end() && first->start == change.t_in;
  return is_first ? floors.levels[change.to].open : "";
}

// What sensors measured of a ride, where it cannot be the way between these floors.
std::string Contradiction(const FloorChange& change, const StoreyOptions& storeys) {
  constexpr double kMostSigmas = 4.0;
  if (!change.climb) return "";
  const double off = std::abs(*change.climb - change.height_m);
  if (off <= std::max(0.5 * storeys.min_gap, kMostSigmas * change.climb_sigma)) return "";
  return "it is taken for one that is " + FixedText(change.height_m, 1) +
         " m above the one left, and sensors climbed " + FixedText(*change.climb, 1) + " m";
}

std::vector<TransitRecord> TransitsOf(const FloorTimeline& floors, const LogStatistics& log,
                                      const StoreyOptions& storeys) {
  constexpr std::pair<FloorSource, const char*> kNames[] = {
      {FloorSource::kLabels, "labels"},
      {FloorSource::kPressure, "pressure"},
      {FloorSource::kAcceleration, "acceleration"},
      {FloorSource::kLidar, "lidar"}};
  std::vector<TransitRecord> transits;
  for (const FloorChange& change : ChangesOf(floors)) {
    TransitRecord transit{std::max(change.t_out, log.first_stamp),
                          std::min(change.t_in, log.last_stamp),
                          change.height_m,
                          change.sigma_m,
                          {},
                          OpenQuestion(floors, change)};
    if (transit.open.empty()) transit.open = Contradiction(change, storeys);
    for (const auto& [source, name] : kNames) {
      if (change.by.Has(source)) transit.by.emplace_back(name);
    }
    transits.push_back(std::move(transit));
  }
  return transits;
}

std::vector<TravelledWay> WayOf(const std::vector<TrajectoryPose>& trajectory) {
  std::vector<TravelledWay> way;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double before = i == 0 ? 0.0 : way.back().travelled_m;
    const Pose2& last = trajectory[i == 0 ? 0 : i - 1].T_odom_robot;
    way.push_back({trajectory[i].stamp, before + Distance(last, trajectory[i].T_odom_robot)});
  }
  return way;
}

// What the checkpoint keeps beside the mapper: the survey, so that the log is not surveyed again.
std::string PackState(const LogSurvey& survey, std::string motion, MaskedMapper& mapper) {
  std::string survey_bytes = PackSurvey(survey);
  std::string mapper_bytes = mapper.SaveState(std::move(motion));
  StateWriter writer;
  writer(survey_bytes, mapper_bytes);
  return writer.Take();
}

// One run over a log, with whatever is kept of it on the way.
class LogDrive {
 public:
  LogDrive(LogSource& source, const std::string& mask, const MappingOptions& options,
           ProgressSink& progress, CheckpointStore* checkpoints)
      : source_(source),
        path_(source.path()),
        mask_(mask),
        options_(options),
        progress_(progress),
        checkpoints_(checkpoints) {
    source_.KeepClouds();
    std::optional<Checkpoint> checkpoint;
    if (checkpoints_ != nullptr) checkpoint = checkpoints_->Load();
    std::string mapper_bytes;
    {
      const StageTimer timer(read_seconds_);
      progress_.Stage(checkpoint ? "resuming" : "reading");
      if (checkpoint) {
        std::string survey_bytes;
        StateReader reader(checkpoint->state.bytes);
        reader(survey_bytes, mapper_bytes);
        reader.RequireEnd();
        survey_ = UnpackSurvey(survey_bytes);
        if (survey_.reconsidered) ReadToTheEnd();
        source_.Mend(survey_.mending);
      } else {
        survey_ = SurveyLog(source_, options_);
      }
    }
    settled_ = options_;
    settled_.motion.source = SettleMotionSource(path_, options_.motion, survey_);
    settled_.motion.wheels_tell_turns = !survey_.mending.turns_left_out;
    Begin();
    if (checkpoint) {
      mapper_->RestoreState(mapper_bytes, std::move(checkpoint->parts));
      Skip(checkpoint->state.observations);
    }
  }

  BuildingMap Map() {
    progress_.Stage("mapping");
    DriveThrough();
    BuildingMap result = mapper_->Finish();
    while (ChangesWereFound(result)) result = MapAgain("mapping, floors parted", result.seconds);
    const bool joined = HasUnknownFloors(survey_.floors) && FloorsWereJoined(result);
    const bool learnt = WheelsWereLearnt(result);
    if (joined || learnt) {
      result =
          MapAgain(joined ? "mapping, floors joined" : "mapping, wheels known", result.seconds);
    }
    result.log = log_->Statistics();
    result.seconds += spent_;
    result.seconds.read += read_seconds_;
    result.motion_source = settled_.motion.source;
    result.transits = TransitsOf(survey_.floors, result.log, settled_.floors.storeys);
    result.drives.emplace_back();
    result.drives.back().log = path_;
    result.drives.back().motion_source = settled_.motion.source;
    TieVisits(mapper_->options().closures, settled_.floor_joins, result);
    TieParallelWalls(options_.closures.optimizer.solver, options_.threads, result);
    result.kept_clouds = CloudsAtPoses(source_.KeptClouds(), result.trajectory);
    result.findings = survey_.findings;
    for (const SensorFinding& finding : survey_.findings) {
      result.warnings.push_back(path_ + ": " + TextOf(finding));
    }
    for (const std::string& warning : survey_.warnings) {
      result.warnings.push_back(path_ + ": " + warning);
    }
    for (const std::string& warning : WarningsOf(result.log)) {
      result.warnings.push_back(path_ + ": " + warning);
    }
    for (const std::string& warning : result.warnings) progress_.Warn(warning);
    return result;
  }

 private:
  // What all of the log says of its sensors is not kept: it is found again.
  void ReadToTheEnd() {
    const std::unique_ptr<LogReader> log = source_.Read();
    while (log->Next()) {
    }
    source_.Reconsider();
  }

  void Begin() {
    if (survey_.wheels) settled_.motion.odometry = *survey_.wheels;
    mapper_.emplace(mask_, settled_, survey_.floors);
    log_ = ReadStraightened(
        source_, {survey_.sweep_s_per_rad, settled_.motion.source != MotionSource::kScans});
    observations_ = scans_ = 0;
  }

  BuildingMap MapAgain(const char* stage, const StageSeconds& spent) {
    progress_.Stage(stage);
    spent_ += spent;  // what is driven again costs twice
    Begin();
    if (checkpoints_ != nullptr) checkpoints_->StartOver();
    DriveThrough();
    return mapper_->Finish();
  }

  // Where nothing but scans would have told, and before levels are joined by how they look.
  bool ChangesWereFound(const BuildingMap& map) {
    const FloorSource source = options_.floors.source;
    const bool scans_tell = source == FloorSource::kAuto || source == FloorSource::kLidar;
    FloorTimeline& floors = survey_.floors;
    if (!scans_tell || floors.joined || survey_.wheels) return false;
    const StageTimer timer(spent_.matching);
    const std::vector<TimeSpan> found = FindUnnoticedChanges(map, floors.heard);
    if (found.empty()) return false;
    std::vector<FloorTransit> transits = TransitsOf(floors);
    const std::size_t known = transits.size();
    for (const TimeSpan& change : found) {
      const auto meets = [&](const FloorTransit& other) {
        return other.start <= change.end && change.start <= other.end;
      };
      if (std::any_of(transits.begin(), transits.end(), meets)) continue;
      FloorTransit transit;
      transit.start = change.start;
      transit.middle = 0.5 * (change.start + change.end);
      transit.end = change.end;
      transit.by.Add(FloorSource::kLidar);
      transits.push_back(transit);
      survey_.warnings.push_back("the way from " + FixedText(change.start, 2) + " to " +
                                 FixedText(change.end, 2) +
                                 " s is taken for one to another floor: walls that were seen "
                                 "before it were driven through after it, or the reverse, and no "
                                 "sensor tells floors");
    }
    if (transits.size() == known) return false;
    std::sort(transits.begin(), transits.end(), [](const auto& one, const auto& other) {
      return std::tie(one.start, one.end) < std::tie(other.start, other.end);
    });
    const std::vector<TimeSpan> heard = floors.heard;
    floors = TimelineOfTransits(transits, options_.floors.storeys);
    floors.heard = heard;
    NoteTravel(WayOf(map.trajectory), floors);
    return true;
  }

  // With a floor met again as one level, its visits are matched with each other like any others;
  // that takes another drive through the log.
  bool FloorsWereJoined(const BuildingMap& map) {
    const StageTimer timer(spent_.matching);
    const FloorJoining joining =
        JoinFloors(map, survey_.floors, settled_.floor_joins, settled_.floors.storeys,
                   mapper_->options().closures.matcher);
    survey_.floors = joining.floors;
    if (!joining.any_joined) return false;
    survey_.warnings.insert(survey_.warnings.end(), joining.notes.begin(), joining.notes.end());
    return true;
  }

  // By wheels alone, how good they are decides what may close, and closures tell how good they are.
  bool WheelsWereLearnt(const BuildingMap& map) {
    if (settled_.motion.source != MotionSource::kOdometry || survey_.wheels) return false;
    const std::optional<LearntWheels> learnt =
        WheelsByClosures(WheelTies(map), settled_.motion.odometry);
    if (!learnt) return false;
    survey_.wheels = learnt->noise;
    survey_.mending.travel_factor *= learnt->travel_factor;
    source_.Mend(survey_.mending);
    return true;
  }

  void DriveThrough() {
    MovedScans scans(*log_, mapper_->motion(), observations_, options_.threads);
    while (std::optional<LoggedScan> scan = scans.Next()) {
      mapper_->Observe(scan->moved);
      ++scans_;
      try {
        progress_.Progress(scan->progress, scans_);
      } catch (...) {  // an interrupt: what is done is kept, unless it is next to nothing
        if (has_saved_ || IsDue()) SaveCheckpointSoon(scans, std::move(*scan));
        throw;
      }
      if (!IsDue()) continue;
      scans.AskForState(*scan);
      SaveCheckpoint(*scan);
    }
    read_seconds_ += scans.read_seconds();
  }

  // Goes on until the motion has said its state.
  void SaveCheckpointSoon(MovedScans& scans, LoggedScan last) {
    scans.AskForState(last);
    while (!last.motion) {
      if (std::optional<LoggedScan> next = scans.Next()) {
        last = std::move(*next);
        mapper_->Observe(last.moved);
      } else {
        scans.AskForState(last);
      }
    }
    SaveCheckpoint(last);
  }

  std::optional<Observation> Next() {
    const StageTimer timer(read_seconds_);
    std::optional<Observation> observation = log_->Next();
    if (observation) ++observations_;
    return observation;
  }

  // The log says again what had gone in; only the mask listens.
  void Skip(std::uint64_t observations) {
    while (observations_ < observations) {
      const std::optional<Observation> observation = Next();
      if (!observation) StateReader::Refuse("a log that is shorter than it was");
      const auto* scan = std::get_if<LaserScan>(&*observation);
      if (scan == nullptr) continue;
      if (scans_ >= mapper_->result().trajectory.size()) StateReader::Refuse("too few poses");
      mapper_->RememberScan(*scan);
      progress_.Progress(log_->Progress(), ++scans_);
    }
    if (scans_ != mapper_->result().trajectory.size()) StateReader::Refuse("too many poses");
  }

  bool IsDue() { return checkpoints_ != nullptr && checkpoints_->IsDue(); }

  /// As of this scan, unless the motion has not said its state there.
  void SaveCheckpoint(const LoggedScan& last) {
    if (checkpoints_ == nullptr || !last.motion) return;
    try {
      has_saved_ = true;
      checkpoints_->Save(
          {last.observations, last.progress, PackState(survey_, *last.motion, *mapper_)},
          mapper_->result());
    } catch (const std::runtime_error& error) {
      progress_.Warn(std::string(error.what()) + "; going on without checkpoints");
      checkpoints_ = nullptr;
    }
  }

  LogSource& source_;
  std::string path_;
  std::string mask_;
  MappingOptions options_;
  MappingOptions settled_;
  ProgressSink& progress_;
  CheckpointStore* checkpoints_;
  LogSurvey survey_;
  std::unique_ptr<LogReader> log_;
  std::optional<MaskedMapper> mapper_;
  std::uint64_t observations_ = 0;
  std::uint64_t scans_ = 0;
  bool has_saved_ = false;
  double read_seconds_ = 0.0;
  StageSeconds spent_;  // by mappers before this one
};

}  // namespace

BuildingMap MapLog(LogSource& source, const std::string& mask, const MappingOptions& options,
                   ProgressSink& progress, CheckpointStore* checkpoints) {
  double total_seconds = 0.0;
  std::optional<StageTimer> total_timer(std::in_place, total_seconds);
  BuildingMap result;
  try {
    result = LogDrive(source, mask, options, progress, checkpoints).Map();
  } catch (const StateError& error) {
    throw InputError(source.path() + ": the checkpoint does not fit this log: " + error.what());
  }
  total_timer.reset();
  result.seconds.total = total_seconds;
  return result;
}

BuildingMap MapLog(const std::string& path, const std::string& mask, const MappingOptions& options,
                   ProgressSink& progress, CheckpointStore* checkpoints) {
  LogSource source(path, options.log);
  return MapLog(source, mask, options, progress, checkpoints);
}

}  // namespace masked_mapper
