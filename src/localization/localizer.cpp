// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "evidence.hpp"
#include "hypotheses.hpp"
#include "known_map.hpp"
#include "masked_mapper/localization/map_changes.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "pose_tracker.hpp"
#include "ride_watch.hpp"
#include "stretch.hpp"

namespace masked_mapper {
namespace {

constexpr double kStep = 1.0;         // m of way, or
constexpr double kStepS = 1.0;        // s, from one look at what is new to the next
constexpr double kLongGap = 20.0;     // s without a scan: the robot may have been carried
constexpr double kFastest = 4.0;      // m/s; what the odometry does beyond it no wheels did
constexpr double kFoundSigma = 0.15;  // m, of a place that was found
constexpr double kFoundSigmaDeg = 1.0;
constexpr double kOpenSigma = 0.15;     // m, from which on a match is due whatever the mask says
constexpr double kHeld = 3.0;           // m of way from a match on which the pose is as good as it
constexpr double kComparedEvery = 0.5;  // m of way between scans that tell what has changed
constexpr double kRetry = 0.5;          // m of way after a match that did not fit
constexpr double kCabRest = 3.0;        // s, that wheels rest in a cab when a ride is noticed
constexpr std::size_t kFew = 24;        // hypotheses that are looked at while the robot rests

UncertainPose2 Widened(UncertainPose2 pose, double sigma_m, double sigma_deg) {
  const double sigma_rad = DegToRad(sigma_deg);
  pose.covariance.diagonal() +=
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return pose;
}

}  // namespace

class Localizer::Impl {
 public:
  Impl(const BuildingMap& map, const std::string& mask, const LocalizerOptions& options)
      : options_(options),
        map_(map, options.floor_search),
        mask_(MakeMask(mask, options.masks)),
        rides_(options.floors),
        hypotheses_(map_, evidence_),
        tracker_(map_, options.closures) {
    hypotheses_.Restart(0);
  }

  bool Observe(const Observation& observation) {
    rides_.Observe(observation);
    if (const auto* label = std::get_if<FloorLabel>(&observation)) Read(*label);
    if (const auto* odometry = std::get_if<OdometryReading>(&observation)) {
      if (motion_) motion_->Observe(*odometry);
    }
    const auto* scan = std::get_if<LaserScan>(&observation);
    if (scan == nullptr) return false;
    ObserveScan(*scan);
    return true;
  }

  const Localization& result() const { return result_; }
  std::vector<MapChange> Changes() const { return changes_.Find(); }

  std::string Doubt() const {
    if (is_sure_) return {};
    const std::size_t places = hypotheses_.all().size();
    if (places == 0) return why_ + "; what is seen was found nowhere in the map so far";
    if (places == 1) return why_ + "; one place comes into question, and is not sure yet";
    std::vector<FloorId> floors;
    for (const Hypothesis& one : hypotheses_.all()) floors.push_back(one.floor);
    std::sort(floors.begin(), floors.end());
    const auto different = std::unique(floors.begin(), floors.end()) - floors.begin();
    return why_ + "; " + std::to_string(places) + " places on " + std::to_string(different) +
           (different == 1 ? " floor" : " floors") + " come into question";
  }

 private:
  void ObserveScan(const LaserScan& scan) {
    if (!motion_) Begin(scan);
    const bool was_carried = WasCarried(scan);
    NoteRest(scan);
    const bool ride_turned = WatchRides();
    motion_->Observe(scan, ride_turned);
    const Pose2& T_odom_robot = motion_->T_odom_robot();
    if (!result_.scans.empty() && !was_carried) {
      travelled_m_ += Distance(result_.scans.back().T_odom_robot, T_odom_robot);
    }
    LocatedScan located;
    located.stamp = scan.stamp;
    located.log_stamp = scan.log_stamp;
    located.T_odom_robot = T_odom_robot;
    result_.scans.push_back(located);
    if (was_carried) GoOnFromWhereItWas();
    if (!is_riding_) mask_->Observe({scan, T_odom_robot});
    stretch_.Add(scan, T_odom_robot);
    if (is_sure_) {
      Track(scan);
    } else {
      Seek();
    }
    Answer();
    result_.matches = tracker_.matches();
    result_.searches = hypotheses_.searches();
    T_raw_before_ = scan.T_odom_robot;
  }

  void NoteRest(const LaserScan& scan) {
    newest_ = scan.stamp;
    constexpr double kCabRadius = 0.25;  // m
    const Pose2 now = scan.T_odom_robot ? *scan.T_odom_robot : motion_->T_odom_robot();
    if (T_rest_ && Distance(*T_rest_, now) <= kCabRadius) return;
    T_rest_ = now;
    moved_at_s_ = scan.stamp;
  }

  void Begin(const LaserScan& scan) {
    MotionOptions motion = options_.motion;
    if (motion.source == MotionSource::kAuto) {
      motion.source = scan.T_odom_robot ? MotionSource::kFused : MotionSource::kScans;
    }
    motion_.emplace(motion);
    why_ = "not found yet";
    result_.unsure_spans.push_back({scan.stamp, scan.stamp, why_});
  }

  bool WasCarried(const LaserScan& scan) {
    if (result_.scans.empty()) return false;
    const double elapsed = scan.stamp - result_.scans.back().stamp;
    if (elapsed > kLongGap) {
      carried_ = "no scan for " + FixedText(elapsed, 1) + " s";
      return true;
    }
    if (!scan.T_odom_robot || !T_raw_before_) return false;
    if (Distance(*T_raw_before_, *scan.T_odom_robot) <= 1.0 + kFastest * elapsed) return false;
    carried_ = "the odometry jumped";
    return true;
  }

  // It may stand where it stood, or anywhere; what was seen before is of another stretch.
  void GoOnFromWhereItWas() {
    const Pose2 T_world_robot = T_matched_robot_before_;
    const std::size_t scan = result_.scans.size() - 1;
    Lose(carried_, scan);
    if (has_place_) {
      hypotheses_.SuggestAround(floor_, T_world_robot * Inverse(motion_->T_odom_robot()));
    }
  }

  void Lose(const std::string& why, std::size_t scan) {
    stretch_.Restart();
    hypotheses_.Restart(scan);
    last_step_m_ = 0.0;
    doubt_nats_ = 0.0;
    why_ = why;
    if (is_sure_) {
      result_.unsure_spans.push_back({result_.scans[scan].stamp, result_.scans[scan].stamp, why});
    }
    is_sure_ = false;
  }

  void Read(const FloorLabel& label) {
    if (label.label == "-" || label.label == label_) return;
    label_ = label.label;
    for (const FloorId floor : map_.floors()) {
      const Floor& known = map_.Facts(floor);
      if (!known.label_given || known.label != label_) continue;
      if (is_sure_) {
        if (floor_ != floor) match_is_due_ = true;
        floor_ = ride_floor_ = floor;
      } else {
        hypotheses_.Ride(std::nullopt, 0.0, result_.scans.size());
        hypotheses_.KeepFloor(floor);
      }
    }
  }

  /// True when a ride begins or ends.
  bool WatchRides() {
    if (!rides_.IsDue()) return false;
    const std::optional<RideNews> news = rides_.News();
    const bool was_riding = is_riding_;
    if (news && !is_riding_) {
      is_riding_ = true;
      ride_floor_ = floor_;
      is_in_cab_ = newest_ - moved_at_s_ >= kCabRest;
      // On stairs the scene changes step by step, and its far walls hold the way.
      if (is_in_cab_) motion_->EnterTransit();
    }
    if (news) Follow(*news);
    if (is_riding_ && (!news || news->is_over)) {
      is_riding_ = false;
      if (!news) floor_ = ride_floor_;
      if (is_in_cab_) motion_->LeaveTransit();
      mask_->Restart();
      match_is_due_ = true;
    }
    return was_riding != is_riding_;
  }

  void Follow(const RideNews& news) {
    if (!is_sure_) {
      if (news.is_over) {
        hypotheses_.Ride(news.climb_m, news.sigma_m, result_.scans.size());
      }
      return;
    }
    const std::vector<FloorId> floors = FloorsReached(news);
    if (floors.size() == 1) {
      floor_ = floors.front();
    } else if (news.is_over && !result_.scans.empty()) {
      const Pose2 T_world_odom = WorldFromOdom();
      Lose(floors.empty() ? "it rode to a floor that the map does not have"
                          : "it rode, and more than one floor may be where to",
           result_.scans.size() - 1);
      if (!floors.empty()) {
        hypotheses_.SuggestAround(ride_floor_, T_world_odom);
        hypotheses_.Ride(news.climb_m, news.sigma_m, result_.scans.size());
      }
    }
  }

  std::vector<FloorId> FloorsReached(const RideNews& news) const {
    constexpr double kSigmas = 3.0;
    constexpr double kSlack = 0.8;  // m
    std::vector<FloorId> reached;
    for (const FloorId floor : map_.floors()) {
      const double step = map_.Facts(floor).elevation - map_.Facts(ride_floor_).elevation;
      if (news.climb_m && std::abs(step - *news.climb_m) > kSigmas * news.sigma_m + kSlack)
        continue;
      reached.push_back(floor);
    }
    return reached;
  }

  UncertainPose2 Here() const { return T_world_matched_ * motion_->T_node_robot(); }
  Pose2 WorldFromOdom() const { return Here().mean * Inverse(motion_->T_odom_robot()); }

  bool IsTimeToStep() const {
    return stretch_.length_m() - last_step_m_ >= kStep ||
           result_.scans.back().stamp - last_step_s_ >= kStepS;
  }

  void NoteStep() {
    last_step_m_ = stretch_.length_m();
    last_step_s_ = result_.scans.back().stamp;
  }

  void Seek() {
    const bool has_moved = stretch_.length_m() - last_step_m_ >= kStep;
    if (is_riding_ || !IsTimeToStep()) return;
    if (!has_moved && hypotheses_.all().size() > kFew) return;
    NoteStep();
    hypotheses_.Step(stretch_, result_.scans.size() - 1);
    if (const Hypothesis* found = hypotheses_.Believed()) Settle(*found);
  }

  void Settle(const Hypothesis& found) {
    for (std::size_t i = 0; i < found.anchors.size(); ++i) {
      const std::size_t end =
          i + 1 < found.anchors.size() ? found.anchors[i + 1].scan : result_.scans.size();
      for (std::size_t k = found.anchors[i].scan; k < end; ++k) {
        LocatedScan& scan = result_.scans[k];
        scan.placed = true;
        scan.floor = found.anchors[i].floor;
        scan.T_world_robot =
            Widened({found.anchors[i].T_world_odom * scan.T_odom_robot, Eigen::Matrix3d::Zero()},
                    kFoundSigma, kFoundSigmaDeg);
      }
    }
    if (!result_.found) {
      result_.found = true;
      result_.found_after_m = travelled_m_;
    }
    floor_ = ride_floor_ = found.floor;
    is_sure_ = has_place_ = true;
    Anchor(Widened({found.T_world_odom * motion_->T_odom_robot(), Eigen::Matrix3d::Zero()},
                   kFoundSigma, kFoundSigmaDeg));
    match_is_due_ = true;
    doubt_nats_ = 0.0;
  }

  void Anchor(const UncertainPose2& T_world_robot) {
    T_world_matched_ = T_world_robot;
    matched_at_m_ = tried_at_m_ = travelled_m_;
    motion_->StartNode();
  }

  void Track(const LaserScan& scan) {
    if (is_riding_) return;
    const double since_match_m = travelled_m_ - matched_at_m_;
    const double since_try_m = travelled_m_ - tried_at_m_;
    const UncertainPose2 here = Here();
    const bool is_open = std::sqrt(here.covariance(0, 0) + here.covariance(1, 1)) > kOpenSigma ||
                         since_match_m > options_.max_edge_length_m;
    const bool by_mask = since_match_m > options_.min_edge_length_m && mask_->Fires();
    if ((by_mask || is_open || match_is_due_) && (since_try_m >= kRetry || match_is_due_)) {
      Match(scan, here);
    }
    if (IsTimeToStep()) Doubt(scan);
    const bool is_held = is_sure_ && travelled_m_ - matched_at_m_ < kHeld;
    if (is_held && travelled_m_ - compared_at_m_ >= kComparedEvery) {
      compared_at_m_ = travelled_m_;
      changes_.Observe(scan, *map_.FloorAt(floor_), Here().mean);
    }
  }

  bool Match(const LaserScan& scan, const UncertainPose2& guess) {
    match_is_due_ = false;
    tried_at_m_ = travelled_m_;
    const std::optional<UncertainPose2> match = tracker_.Match(PointsInRobot(scan), floor_, guess);
    if (!match) return false;
    Anchor(*match);
    mask_->OnNode();
    return true;
  }

  // Whether what is new is of another place after all.
  void Doubt(const LaserScan& scan) {
    NoteStep();
    Tally tally;
    const Pose2 T_world_odom = WorldFromOdom();
    for (const Patch& patch : stretch_.TakePatches()) {
      tally.Add(patch, FitOf(patch, *map_.FloorAt(floor_), T_world_odom));
    }
    doubt_nats_ = std::max(0.0, doubt_nats_ - NatsOf(tally, evidence_.agrees_anywhere, evidence_));
    if (doubt_nats_ < evidence_.believed_nats) return;
    constexpr double kLookAround = 0.3;  // m
    constexpr double kLookAroundDeg = 3.0;
    if (Match(scan, Widened(Here(), kLookAround, kLookAroundDeg))) {
      doubt_nats_ = 0.0;
      return;
    }
    Lose("what it saw did not fit the map any more", result_.scans.size() - 1);
    hypotheses_.SuggestAround(floor_, T_world_odom);
  }

  void Answer() {
    LocatedScan& now = result_.scans.back();
    if (!is_sure_) {
      result_.unsure_spans.back().t_b = now.stamp;
      return;
    }
    now.sure = now.placed = true;
    now.floor = floor_;
    now.T_world_robot = Here();
    T_matched_robot_before_ = now.T_world_robot.mean;
  }

  LocalizerOptions options_;
  EvidenceOptions evidence_;
  KnownMap map_;
  std::unique_ptr<Mask> mask_;
  std::optional<MotionEstimator> motion_;
  RideWatch rides_;
  Stretch stretch_;
  Hypotheses hypotheses_;
  PoseTracker tracker_;
  ChangeFinder changes_;
  Localization result_;

  bool is_sure_ = false;
  bool has_place_ = false;  ///< was sure before
  FloorId floor_ = 0;
  UncertainPose2 T_world_matched_;  ///< where motion counts from
  Pose2 T_matched_robot_before_;    ///< T_world_robot of the scan before
  double matched_at_m_ = 0.0;
  double compared_at_m_ = 0.0;
  double tried_at_m_ = 0.0;
  bool match_is_due_ = false;
  double doubt_nats_ = 0.0;

  bool is_riding_ = false;
  bool is_in_cab_ = false;   ///< the ride that goes on, or the last
  double newest_ = 0.0;      ///< s
  double moved_at_s_ = 0.0;  ///< s, since when the robot rests
  std::optional<Pose2> T_rest_;
  FloorId ride_floor_ = 0;  ///< left last
  std::string label_;
  std::string why_;
  std::string carried_;
  std::optional<Pose2> T_raw_before_;
  double travelled_m_ = 0.0;
  double last_step_m_ = 0.0;
  double last_step_s_ = -1e9;
};

Localizer::Localizer(const BuildingMap& map, const std::string& mask,
                     const LocalizerOptions& options)
    : impl_(std::make_unique<Impl>(map, mask, options)) {}
Localizer::~Localizer() = default;

bool Localizer::Observe(const Observation& observation) { return impl_->Observe(observation); }
const Localization& Localizer::result() const { return impl_->result(); }
std::vector<MapChange> Localizer::Changes() const { return impl_->Changes(); }
std::string Localizer::Doubt() const { return impl_->Doubt(); }

}  // namespace masked_mapper
