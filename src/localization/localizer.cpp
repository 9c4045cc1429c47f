// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "answers.hpp"
#include "driven_way.hpp"
#include "evidence.hpp"
#include "held_place.hpp"
#include "hypotheses.hpp"
#include "known_map.hpp"
#include "map_changes.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "ride_watch.hpp"
#include "stretch.hpp"

namespace masked_mapper {
namespace {

constexpr double kStep = 1.0;   // m of way, or
constexpr double kStepS = 1.0;  // s, from one look at what is new to the next
constexpr double kCarriedSigma =
    0.5;  // m, of a robot that was carried, if it stands where it stood
constexpr double kCarriedSigmaDeg = 5.0;
constexpr double kHeld = 3.0;           // m of way from a match on which the pose is as good as it
constexpr double kComparedEvery = 0.5;  // m of way between scans that tell what has changed
constexpr double kLanding = 20.0;       // m of way; what is larger is a floor
constexpr std::size_t kFew = 24;        // hypotheses that are looked at while the robot rests

}  // namespace

class Localizer::Impl {
 public:
  Impl(const BuildingMap& map, const std::string& mask, const LocalizerOptions& options)
      : options_(options),
        map_(map, options.floor_search),
        mask_(MakeMask(mask, options.masks)),
        way_(options.motion),
        rides_(options.floors),
        hypotheses_(map_, evidence_),
        place_(map_, options.closures, evidence_,
               {options.min_edge_length_m, options.max_edge_length_m}) {
    hypotheses_.Restart(0);
  }

  bool Observe(const Observation& observation) {
    rides_.Observe(observation);
    if (const auto* label = std::get_if<FloorLabel>(&observation)) Read(*label);
    if (const auto* odometry = std::get_if<OdometryReading>(&observation)) way_.Observe(*odometry);
    const auto* scan = std::get_if<LaserScan>(&observation);
    if (scan == nullptr) return false;
    ObserveScan(*scan);
    return true;
  }

  void BeginLog(MotionSource source) {
    if (way_.HasBegun()) mask_->Restart();
    way_.BeginLog(source);
    rides_ = RideWatch(options_.floors);
    is_riding_ = false;
    label_.clear();
  }

  const Localization& result() const { return answers_.result(); }
  std::vector<MapChange> Changes() const {
    return changes_.Find(
        [&](FloorId floor) -> const std::vector<PosedScan>& { return map_.ScansOf(floor); });
  }

  std::string Doubt() const {
    if (answers_.IsSure()) return {};
    if (!had_place_) return hypotheses_.Description();
    return is_held_ ? why_ : why_ + "; " + hypotheses_.Description();
  }

 private:
  void ObserveScan(const LaserScan& bent) {
    const bool ride_turned = way_.HasBegun() && WatchRides();
    const LaserScan scan = way_.Observe(bent, ride_turned);
    const Pose2& T_odom_robot = way_.motion().T_odom_robot();
    rides_.NotePose(scan.T_odom_robot ? *scan.T_odom_robot : T_odom_robot);
    place_.Travel(way_.step_m());
    answers_.Add(scan, T_odom_robot);
    if (!way_.carried().empty()) GoOnFromWhereItWas();
    if (!is_riding_) mask_->Observe({scan, T_odom_robot});
    if (is_held_) {
      Track(scan);
    } else {
      stretch_.Add(scan, T_odom_robot);
      Seek();
    }
    Answer();
    labelled_.reset();
  }

  // It may stand where it stood, or anywhere; what was seen before is of another stretch.
  void GoOnFromWhereItWas() {
    const std::size_t scan = answers_.Last();
    Lose(way_.carried(), scan);
    if (had_place_) {
      place_.Take(place_.floor(), Widened(T_world_robot_before_, kCarriedSigma, kCarriedSigmaDeg),
                  way_.motion());
      SuggestHere(place_.floor());
    }
    if (labelled_) hypotheses_.KeepFloor(*labelled_);
  }

  void SuggestHere(FloorId floor) {
    hypotheses_.SuggestAround(floor, place_.WorldFromOdom(way_.motion()));
  }

  void Lose(const std::string& why, std::size_t scan) {
    stretch_.Restart();
    hypotheses_.Restart(scan);
    last_step_m_ = way_.travelled_m();
    last_step_s_ = -1e9;
    why_ = why;
    is_held_ = false;
  }

  void Read(const FloorLabel& label) {
    if (label.label == "-" || label.label == label_) return;
    label_ = label.label;
    for (const FloorId floor : map_.floors()) {
      const Floor& known = map_.Facts(floor);
      if (!known.label_given || known.label != label_) continue;
      labelled_ = floor;
      if (is_held_) {
        if (place_.floor() != floor) place_.WantMatch();
        place_.SetFloor(floor);
        ride_floor_ = floor;
      } else {
        hypotheses_.Ride(std::nullopt, 0.0, answers_.result().scans.size());
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
      ride_floor_ = place_.floor();
      is_in_cab_ = rides_.IsResting();
      // On stairs the scene changes step by step, and its far walls hold the way.
      if (is_in_cab_) way_.motion().EnterTransit();
    }
    if (news) Follow(*news);
    if (is_riding_ && (!news || news->is_over)) {
      is_riding_ = false;
      if (!news) place_.SetFloor(ride_floor_);
      if (is_in_cab_) way_.motion().LeaveTransit();
      mask_->Restart();
      place_.WantMatch();
    }
    return was_riding != is_riding_;
  }

  void Follow(const RideNews& news) {
    if (!is_held_) {
      if (news.is_over)
        hypotheses_.Ride(news.climb_m, news.sigma_m, answers_.result().scans.size());
      return;
    }
    const std::vector<FloorId> floors = map_.FloorsReached(ride_floor_, news.climb_m, news.sigma_m);
    if (floors.size() == 1) {
      place_.SetFloor(floors.front());
    } else if (news.is_over && !answers_.empty()) {
      Lose(floors.empty() ? "it rode to no floor that the map has"
                          : "it rode, and more than one floor may be where to",
           answers_.Last());
      hypotheses_.Suggest(ride_floor_, place_.WorldFromOdom(way_.motion()), 0.0);
      hypotheses_.Ride(news.climb_m, news.sigma_m, answers_.result().scans.size());
    }
  }

  bool IsTimeToStep() const {
    return way_.travelled_m() - last_step_m_ >= kStep ||
           answers_.LastStamp() - last_step_s_ >= kStepS;
  }

  void NoteStep() {
    last_step_m_ = way_.travelled_m();
    last_step_s_ = answers_.LastStamp();
  }

  void Seek() {
    const bool has_moved = way_.travelled_m() - last_step_m_ >= kStep;
    if (is_riding_ || !IsTimeToStep()) return;
    if (hypotheses_.IsBetweenFloors()) {
      if (stretch_.length_m() < kLanding) return;
      Lose("it rode to no floor that the map has", answers_.Last());
    }
    if (!has_moved && hypotheses_.all().size() > kFew) return;
    NoteStep();
    std::optional<UncertainPose2> by_motion;
    if (had_place_) by_motion = place_.Robot(way_.motion());
    hypotheses_.Step(stretch_, answers_.Last(), by_motion);
    if (const Hypothesis* found = hypotheses_.Believed()) Settle(*found);
  }

  void Settle(const Hypothesis& found) {
    answers_.PlaceInHindsight(found);
    is_held_ = had_place_ = true;
    why_ = "nothing of the map told its pose for long";
    ride_floor_ = found.floor;
    place_.Take(found.floor, Found(found.T_world_odom * way_.motion().T_odom_robot()),
                way_.motion());
    place_.WantMatch();
  }

  void Track(const LaserScan& scan) {
    if (is_riding_) return;
    place_.Track(scan, *mask_, way_.motion());
    if (IsTimeToStep()) {
      NoteStep();
      if (!place_.Agrees(scan, *mask_, way_.motion())) {
        GoOnLooking("what it saw did not fit the map any more");
        return;
      }
    }
    if (SigmaM(place_.Robot(way_.motion())) > kPlaceM) {
      GoOnLooking("it went far where nothing fitted the map");
      return;
    }
    if (place_.SinceMatch() < kHeld && way_.travelled_m() - compared_at_m_ >= kComparedEvery) {
      compared_at_m_ = way_.travelled_m();
      changes_.Observe(scan, *map_.FloorAt(place_.floor()), place_.Robot(way_.motion()).mean);
    }
  }

  void GoOnLooking(const std::string& why) {
    Lose(why, answers_.Last());
    SuggestHere(place_.floor());
  }

  void Answer() {
    if (is_held_) {
      const UncertainPose2 T_world_robot = place_.Robot(way_.motion());
      answers_.Place(place_.floor(), T_world_robot, way_.travelled_m());
      T_world_robot_before_ = T_world_robot;
    }
    answers_.Close(why_);
    answers_.result().matches = place_.matches();
    answers_.result().searches = hypotheses_.searches();
  }

  LocalizerOptions options_;
  EvidenceOptions evidence_;
  KnownMap map_;
  std::unique_ptr<Mask> mask_;
  DrivenWay way_;
  RideWatch rides_;
  Stretch stretch_;
  Hypotheses hypotheses_;
  HeldPlace place_;
  ChangeFinder changes_;
  Answers answers_;

  bool is_held_ = false;                 ///< its place is believed
  bool had_place_ = false;               ///< is sure, or was
  UncertainPose2 T_world_robot_before_;  ///< at the last scan at which it was sure
  double compared_at_m_ = 0.0;

  bool is_riding_ = false;
  bool is_in_cab_ = false;  ///< on the ride that goes on, or the last
  FloorId ride_floor_ = 0;  ///< left last
  std::string label_;
  std::optional<FloorId> labelled_;  ///< the floor that was said since the last scan
  std::string why_ = "not found yet";
  double last_step_m_ = 0.0;
  double last_step_s_ = -1e9;
};

Localizer::Localizer(const BuildingMap& map, const std::string& mask,
                     const LocalizerOptions& options)
    : impl_(std::make_unique<Impl>(map, mask, options)) {}
Localizer::~Localizer() = default;

void Localizer::BeginLog(MotionSource source) { impl_->BeginLog(source); }
bool Localizer::Observe(const Observation& observation) { return impl_->Observe(observation); }
const Localization& Localizer::result() const { return impl_->result(); }
std::vector<MapChange> Localizer::Changes() const { return impl_->Changes(); }
std::string Localizer::Doubt() const { return impl_->Doubt(); }

}  // namespace masked_mapper
