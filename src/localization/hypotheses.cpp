// SPDX-License-Identifier: BSD-3-Clause
#include "hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace masked_mapper {
namespace {

constexpr double kFirstSearch = 2.0;  // m of the way; before it a scan or two are no place
constexpr double kSearched = 16.0;    // m of the way that are looked for
constexpr double kJudged = 40.0;      // m of the way by which what is found is judged
constexpr double kFollowed = 4.0;     // m of the way by which a hypothesis is held in place
constexpr double kAlike = 0.12;       // of score; what fits that much worse is no rival
constexpr double kLeastScore = 0.5;   // of the coarse search
constexpr std::size_t kMost = 400;    // hypotheses
constexpr double kSameM = 0.3;        // what is nearer to a known one is no better
constexpr double kSameDeg = 2.0;

}  // namespace

void Hypotheses::Restart(std::size_t scan) {
  hypotheses_.clear();
  patches_.clear();
  first_scan_ = scan;
  next_search_m_ = kFirstSearch;
  search_was_complete_ = false;
  whereabouts_.clear();
  only_floors_.clear();
  climbed_.reset();
  elsewhere_nats_ = 0.0;
}

void Hypotheses::Suggest(FloorId floor, const Pose2& T_world_odom, double prior_nats) {
  Hypothesis hypothesis;
  hypothesis.floor = floor;
  hypothesis.T_world_odom = T_world_odom;
  hypothesis.prior_nats = prior_nats;
  hypothesis.anchors.push_back({first_scan_, floor, T_world_odom});
  hypotheses_.push_back(std::move(hypothesis));
  whereabouts_.emplace_back(floor, prior_nats);
}

void Hypotheses::SuggestAround(FloorId floor, const Pose2& T_world_odom) {
  // A robot is likelier where it was, or a ride away, than anywhere else.
  constexpr double kStays = 0.5;
  const auto others = static_cast<double>(std::max<std::size_t>(2, map_.floors().size()) - 1);
  for (const FloorId other : map_.floors()) {
    Suggest(other, T_world_odom, std::log(other == floor ? kStays : 0.5 * (1.0 - kStays) / others));
  }
}

void Hypotheses::KeepFloor(FloorId floor) {
  only_floors_ = {floor};
  whereabouts_.erase(std::remove_if(whereabouts_.begin(), whereabouts_.end(),
                                    [&](const auto& one) { return one.first != floor; }),
                     whereabouts_.end());
  hypotheses_.erase(std::remove_if(hypotheses_.begin(), hypotheses_.end(),
                                   [&](const Hypothesis& one) { return one.floor != floor; }),
                    hypotheses_.end());
}

void Hypotheses::Ride(std::optional<double> climb_m, double sigma_m, std::size_t scan) {
  if (climb_m && climbed_) {
    *climb_m += climbed_->m;
    sigma_m = std::hypot(sigma_m, climbed_->sigma_m);
  }
  std::vector<Hypothesis> after;
  for (const Hypothesis& before : hypotheses_) {
    for (const FloorId floor : map_.FloorsReached(before.floor, climb_m, sigma_m)) {
      after.push_back(before);
      after.back().floor = floor;
      after.back().anchors.push_back({scan, floor, before.T_world_odom});
    }
  }
  climbed_.reset();
  if (after.empty() && !hypotheses_.empty() && climb_m) {
    climbed_ = Climb{*climb_m, sigma_m};
    return;
  }
  // Floors may look alike, rides do not: so it is with what the ride does not come to.
  if (climb_m && !after.empty()) {
    elsewhere_nats_ = std::max(elsewhere_nats_, NatsAgainstElsewhere());
  }
  hypotheses_ = std::move(after);
  RideOn(climb_m, sigma_m);
  Whereabouts about;
  for (const auto& [before, nats] : whereabouts_) {
    for (const FloorId floor : map_.FloorsReached(before, climb_m, sigma_m)) {
      const auto known = std::find_if(about.begin(), about.end(),
                                      [&](const auto& one) { return one.first == floor; });
      if (known == about.end()) {
        about.emplace_back(floor, nats);
      } else {
        known->second = std::max(known->second, nats);
      }
    }
  }
  whereabouts_ = std::move(about);
}

bool Hypotheses::MayBeOn(FloorId floor) const {
  return only_floors_.empty() ||
         std::find(only_floors_.begin(), only_floors_.end(), floor) != only_floors_.end();
}

// What was said of floors rides along. A search of those alone looked at none that are new.
void Hypotheses::RideOn(std::optional<double> climb_m, double sigma_m) {
  if (only_floors_.empty()) return;
  std::set<FloorId> reached;
  for (const FloorId floor : only_floors_) {
    for (const FloorId other : map_.FloorsReached(floor, climb_m, sigma_m)) reached.insert(other);
  }
  if (reached.size() > only_floors_.size()) {
    search_was_complete_ = false;
    next_search_m_ = kFirstSearch;
  }
  only_floors_.assign(reached.begin(), reached.end());
}

// What an earlier search, which was complete, did not come upon, and fits later, must have been
// elsewhere before, against which all speaks that was seen there.
double Hypotheses::NatsAgainstElsewhere() const {
  if (!search_was_complete_ || hypotheses_.empty()) return 0.0;
  return std::clamp(Nats(hypotheses_.front()), 0.0, options_.believed_nats);
}

void Hypotheses::Judge(Hypothesis& hypothesis, std::size_t first_patch) const {
  const SearchableFloor& floor = *map_.FloorAt(hypothesis.floor);
  hypothesis.fits.resize(first_patch, kMapSaysNothing);
  for (std::size_t i = first_patch; i < patches_.size(); ++i) {
    hypothesis.fits.push_back(FitOf(patches_[i].patch, floor, hypothesis.T_world_odom));
    hypothesis.tally.Add(hypothesis.fits.back());
    hypothesis.off_the_map.Add(hypothesis.fits.back(), patches_[i].at_m, options_);
  }
}

void Hypotheses::NoteSlip(Hypothesis& hypothesis, const Stretch& stretch) const {
  if (stretch.length_m() < hypothesis.found_m + kFollowed) return;
  if (!hypothesis.settled) hypothesis.settled = {hypothesis.T_world_odom, stretch.length_m()};
  const Pose2 T_world_slipped = hypothesis.T_world_odom * stretch.T_odom_robot();
  const Pose2 T_world_unslipped = hypothesis.settled->T_world_odom * stretch.T_odom_robot();
  hypothesis.slip_nats = SlipNats(Distance(T_world_slipped, T_world_unslipped),
                                  stretch.length_m() - hypothesis.settled->at_m);
}

// The motion path drifts; what was seen last holds it in place.
void Hypotheses::Follow(Hypothesis& hypothesis, const Stretch& stretch, std::size_t scan) const {
  constexpr double kLeastFit = 0.4;
  constexpr double kLargestStep = 0.3;  // m
  const FloorSearch& fine = map_.FloorAt(hypothesis.floor)->fine();
  const Pose2 T_world_robot = hypothesis.T_world_odom * stretch.T_odom_robot();
  const PlaceFit fit = fine.Climb(fine.Thinned(*stretch.Points(kFollowed)), T_world_robot);
  if (fit.score < kLeastFit || Distance(fit.T_world_place, T_world_robot) > kLargestStep) return;
  hypothesis.T_world_odom = fit.T_world_place * Inverse(stretch.T_odom_robot());
  NoteSlip(hypothesis, stretch);
  hypothesis.anchors.push_back({scan, hypothesis.floor, hypothesis.T_world_odom});
}

void Hypotheses::Step(Stretch& stretch, std::size_t scan,
                      const std::optional<UncertainPose2>& T_world_robot) {
  const std::size_t known = patches_.size();
  for (Patch& patch : stretch.TakePatches()) {
    patches_.push_back({std::move(patch), stretch.length_m()});
  }
  for (SeenPatch& old : patches_) {  // none found later is judged by it
    if (old.at_m < stretch.length_m() - kJudged) old.patch.points_in_odom.clear();
  }
  for (Hypothesis& hypothesis : hypotheses_) {
    Follow(hypothesis, stretch, scan);
    Judge(hypothesis, known);
  }
  if (stretch.length_m() >= next_search_m_) {
    // A search costs what the map is large; in the end each stretch is looked for but once.
    next_search_m_ =
        stretch.length_m() + std::clamp(0.25 * stretch.length_m(), kFirstSearch, kSearched);
    if (T_world_robot) SearchAround(stretch, *T_world_robot);
    Search(stretch);
  }
  MergeAndOrder(stretch.T_odom_robot());
  Prune();
}

bool Hypotheses::IsKnown(const Hypothesis& found, const Pose2& T_odom_robot, double same_m,
                         double same_deg) const {
  const Pose2 T_world_found = found.T_world_odom * T_odom_robot;
  return std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& known) {
    const Pose2 T_world_known = known.T_world_odom * T_odom_robot;
    return known.floor == found.floor && Distance(T_world_known, T_world_found) < same_m &&
           std::abs(WrapAngle(T_world_known.theta - T_world_found.theta)) < DegToRad(same_deg);
  });
}

// Judged by what was seen for so long that the motion path still holds together.
void Hypotheses::Add(Hypothesis&& hypothesis) {
  std::size_t first_patch = patches_.size();
  while (first_patch > 0 && !patches_[first_patch - 1].patch.points_in_odom.empty()) --first_patch;
  hypothesis.anchors.push_back({first_scan_, hypothesis.floor, hypothesis.T_world_odom});
  hypothesis.first_patch = first_patch;
  Judge(hypothesis, first_patch);
  hypotheses_.push_back(std::move(hypothesis));
}

// A robot that went far where nothing fitted is somewhere within what its motion leaves open.
void Hypotheses::SearchAround(const Stretch& stretch, const UncertainPose2& T_world_robot) {
  constexpr double kSigmas = 3.0;
  constexpr double kMostM = 5.0;
  constexpr double kMostDeg = 20.0;
  const Eigen::Matrix3d& covariance = T_world_robot.covariance;
  const double within_m = std::clamp(
      kSigmas * std::sqrt(std::max(covariance(0, 0), covariance(1, 1))), kPlaceM, kMostM);
  const double within_deg =
      std::clamp(kSigmas * RadToDeg(std::sqrt(covariance(2, 2))), kPlaceDeg, kMostDeg);
  const double places =
      (2.0 * within_m / kPlaceM) * (2.0 * within_m / kPlaceM) * (2.0 * within_deg / kPlaceDeg);
  const ScanPoints::Ptr points = stretch.Points(kSearched);
  for (const auto& [id, nats] : whereabouts_) {
    const FloorSearch& fine = map_.FloorAt(id)->fine();
    const std::vector<Eigen::Vector2d> thinned = fine.Thinned(*points);
    // From the scan taken in last to the one observed last is less than the search looks at.
    const PlaceFit near = fine.FindNear(thinned, T_world_robot.mean, within_m, within_deg);
    if (near.score < kLeastScore) continue;
    Hypothesis hypothesis;
    hypothesis.floor = id;
    hypothesis.prior_nats = nats - std::log(places);
    hypothesis.found_m = stretch.length_m();
    hypothesis.T_world_odom =
        fine.Climb(thinned, near.T_world_place).T_world_place * Inverse(stretch.T_odom_robot());
    if (!IsKnown(hypothesis, stretch.T_odom_robot(), kSameM, kSameDeg)) Add(std::move(hypothesis));
  }
}

void Hypotheses::Search(const Stretch& stretch) {
  const ScanPoints::Ptr points = stretch.Points(kSearched);
  ++searches_;
  const double elsewhere_nats = std::max(elsewhere_nats_, NatsAgainstElsewhere());
  search_was_complete_ = true;
  double best = 0.0;
  std::vector<std::pair<FloorId, std::vector<Eigen::Vector2d>>> searched;
  for (const FloorId id : map_.floors()) {
    if (!MayBeOn(id)) continue;
    const FloorSearch& coarse = map_.FloorAt(id)->coarse();
    std::vector<Eigen::Vector2d> thinned = coarse.Thinned(*points);
    const std::optional<PlaceFit> fit = coarse.Find(thinned);
    if (!fit) continue;
    best = std::max(best, fit->score);
    searched.emplace_back(id, std::move(thinned));
  }
  if (best == 0.0) return;
  const std::vector<Eigen::Vector2d> fine_points =
      map_.FloorAt(searched.front().first)->fine().Thinned(*points);
  std::vector<std::pair<double, Hypothesis>> found;
  for (const auto& [id, thinned] : searched) {
    const SearchableFloor& floor = *map_.FloorAt(id);
    for (const PlaceFit& coarse : floor.coarse().FindAll(
             thinned, std::max(kLeastScore, best - kAlike), kPlaceM, kPlaceDeg)) {
      Hypothesis hypothesis;
      hypothesis.floor = id;
      hypothesis.prior_nats = -map_.LogPlaces() - elsewhere_nats;
      hypothesis.found_m = stretch.length_m();
      const double within_m = 0.5;
      const PlaceFit fine = floor.fine().FindNear(fine_points, coarse.T_world_place, within_m, 2.0);
      hypothesis.T_world_odom = floor.fine().Climb(fine_points, fine.T_world_place).T_world_place *
                                Inverse(stretch.T_odom_robot());
      if (!IsKnown(hypothesis, stretch.T_odom_robot(), kSameM, kSameDeg)) {
        found.emplace_back(coarse.score, std::move(hypothesis));
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  const std::size_t room = kMost - std::min(kMost, hypotheses_.size());
  if (found.size() > room) {
    search_was_complete_ = false;
    found.resize(room);
  }
  for (auto& [score, hypothesis] : found) Add(std::move(hypothesis));
}

// Of two at one place the likelier stays.
void Hypotheses::MergeAndOrder(const Pose2& T_odom_robot) {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [&](const Hypothesis& a, const Hypothesis& b) { return Nats(a) > Nats(b); });
  std::vector<Hypothesis> all;
  all.swap(hypotheses_);
  for (Hypothesis& one : all) {
    if (!IsKnown(one, T_odom_robot, kPlaceM, kPlaceDeg)) hypotheses_.push_back(std::move(one));
  }
}

// What the best has left behind for good, and what the map contradicts for itself.
void Hypotheses::Prune() {
  if (hypotheses_.empty()) return;
  const Hypothesis best = hypotheses_.front();
  const double gone = 2.0 * options_.told_apart_nats;
  hypotheses_.erase(std::remove_if(hypotheses_.begin(), hypotheses_.end(),
                                   [&](const Hypothesis& one) {
                                     return NatsOf(one.tally, options_.agrees_anywhere, options_) <
                                                -gone ||
                                            LeadOf(best.fits, one.fits, options_) > gone;
                                   }),
                    hypotheses_.end());
}

const Hypothesis* Hypotheses::Believed() const {
  if (hypotheses_.empty()) return nullptr;
  const Hypothesis& best = hypotheses_.front();
  if (Nats(best) < options_.believed_nats) return nullptr;
  const bool was_found = best.prior_nats <= -map_.LogPlaces();
  if (was_found && !search_was_complete_) return nullptr;
  const bool is_alone = std::all_of(hypotheses_.begin() + 1, hypotheses_.end(),
                                    [&](const Hypothesis& rival) { return IsBehind(rival, best); });
  return is_alone ? &best : nullptr;
}

std::string Hypotheses::Description() const {
  if (IsBetweenFloors()) return "it is between floors, or on one that the map does not have";
  const std::size_t places = hypotheses_.size();
  if (places == 0) return "what is seen was found nowhere in the map so far";
  if (places == 1) return "one place comes into question, and is not sure yet";
  std::set<FloorId> floors;
  for (const Hypothesis& one : hypotheses_) floors.insert(one.floor);
  return std::to_string(places) + " places on " + std::to_string(floors.size()) +
         (floors.size() == 1 ? " floor" : " floors") + " come into question";
}

double Hypotheses::NatsOffTheMap(const Hypothesis& hypothesis, std::size_t first_patch) const {
  WayOffTheMap way;
  for (std::size_t i = first_patch; i < hypothesis.fits.size(); ++i) {
    way.Add(hypothesis.fits[i], patches_[i].at_m, options_);
  }
  return way.nats();
}

bool Hypotheses::IsBehind(const Hypothesis& rival, const Hypothesis& best) const {
  const double prior = std::max(0.0, best.prior_nats - rival.prior_nats);
  // Over the way by which both were judged: of one that was found late, nothing before it is known.
  const std::size_t since = std::max(rival.first_patch, best.first_patch);
  const double off_the_map = NatsOffTheMap(best, since) - NatsOffTheMap(rival, since);
  const double slips = best.slip_nats - rival.slip_nats;
  return LeadOf(best.fits, rival.fits, options_) + prior + off_the_map + slips >=
         options_.told_apart_nats;
}

}  // namespace masked_mapper
