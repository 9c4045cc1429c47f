// SPDX-License-Identifier: BSD-3-Clause
#include "piece_search.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"
#include "place_fits.hpp"

namespace masked_mapper {
namespace {

constexpr double kSameHeight = 1.2;  // m; well below a storey, well above what a barometer drifts
constexpr std::size_t kMostGuesses = 40;  // looked at
constexpr double kAlike = 0.08;      // of score, within which two fits of a place are both kept
constexpr double kSameShiftM = 2.0;  // two guesses that differ by less are one
constexpr double kSameTurnDeg = 6.0;

struct Guess {
  std::map<FloorId, FloorId> older_floor_of;
  Pose2 T_older_newer;
  int votes = 0;
  std::vector<std::optional<double>> score_of_place;  ///< empty: not within the older piece
  int fitting = 0;
  int within = 0;
  double spread_m = 0.0;
  bool is_valid = false;
};

class PieceFinder {
 public:
  PieceFinder(const BuildingMap& map, const PieceQuestion& question,
              const DriveJoinOptions& options, const MatcherOptions& matcher)
      : map_(map),
        question_(question),
        matcher_(matcher),
        joins_(options),
        fits_(map, options, matcher, question.is_floor) {}

  PieceSearchResult Find() {
    if (question_.prior) {
      fits_.ReadPlacesAlongTheWay(question_.newer);
    } else {
      fits_.ReadPlacesAtNodes(question_.newer);
    }
    if (fits_.places().empty()) return {std::nullopt, "no place of it was seen well enough", {}};
    fits_.ReadFloors(question_.older);
    std::vector<Guess> guesses = MakeGuesses();
    if (guesses.empty()) return {std::nullopt, "none of its places was found in the map", {}};
    ForEach(guesses.size(), matcher_.threads, [&](std::size_t i) { LookAt(guesses[i]); });
    return Decide(guesses);
  }

 private:
  const Floor& FloorAt(FloorId floor) const {
    return map_.graph.floors()[static_cast<std::size_t>(floor)];
  }

  bool MayBeOne(FloorId older, FloorId newer) const {
    const Floor& one = FloorAt(older);
    const Floor& other = FloorAt(newer);
    return !(one.label_given && other.label_given) || one.label == other.label;
  }

  // Heights are compared where both were measured, and neither floor's label says more.
  bool HeightsCount(FloorId older, FloorId newer) const {
    const Floor& one = FloorAt(older);
    const Floor& other = FloorAt(newer);
    return one.elevation_measured && other.elevation_measured &&
           !(one.label_given && other.label_given);
  }

  // The pairing of floors that follows from one pair; floors whose heights say nothing stay out.
  std::map<FloorId, FloorId> PairingFrom(FloorId older, FloorId newer) const {
    std::map<FloorId, FloorId> pairing{{newer, older}};
    std::set<FloorId> taken{older};
    std::set<FloorId> newer_floors;
    for (const Place& place : fits_.places()) newer_floors.insert(place.floor);
    const double shift = FloorAt(older).elevation - FloorAt(newer).elevation;
    for (const FloorId floor : newer_floors) {
      if (floor == newer) continue;
      std::optional<FloorId> best;
      double smallest = kSameHeight;
      for (const OldFloor& known : fits_.floors()) {
        if (taken.count(known.id) != 0 || !MayBeOne(known.id, floor)) continue;
        if (FloorAt(known.id).label_given && FloorAt(floor).label_given) {
          best = known.id;
          break;
        }
        if (!HeightsCount(older, newer) || !HeightsCount(known.id, floor)) continue;
        const double off = std::abs(FloorAt(known.id).elevation - FloorAt(floor).elevation - shift);
        if (off >= smallest) continue;
        smallest = off;
        best = known.id;
      }
      if (!best) continue;
      pairing[floor] = *best;
      taken.insert(*best);
    }
    return pairing;
  }

  // Whether the heights leave it open which floor this one is.
  bool IsOpen(const Guess& guess, FloorId newer) const {
    if (guess.older_floor_of.count(newer) != 0) return false;
    return std::any_of(fits_.floors().begin(), fits_.floors().end(), [&](const OldFloor& known) {
      return MayBeOne(known.id, newer) && !HeightsCount(known.id, newer);
    });
  }

  // On the whole floor, or as far from where it should be as the prior allows.
  std::optional<PlaceFit> Look(const Place& place, const OldFloor& floor) const {
    if (!question_.prior) return floor.scene.coarse().Find(place.coarse_points);
    const PiecePrior& prior = *question_.prior;
    const double away = Distance(prior.T_world_anchor, place.T_world_place);
    const PlaceFit fit = floor.scene.coarse().FindNear(
        place.coarse_points, place.T_world_place,
        prior.within_m + away * std::sin(DegToRad(prior.within_deg)), prior.within_deg);
    if (fit.score < joins_.search.min_score) return std::nullopt;
    return fit;
  }

  // A few places, evenly over all of them, are looked for on every floor that they may be on.
  std::vector<Guess> MakeGuesses() const {
    const auto most = static_cast<std::size_t>(joins_.searched_places);
    const std::size_t step = std::max<std::size_t>(1, (fits_.places().size() + most - 1) / most);
    struct Search {
      const Place* place;
      const OldFloor* floor;
      std::optional<PlaceFit> fit;
    };
    std::vector<Search> searches;
    for (std::size_t i = 0; i < fits_.places().size(); i += step) {
      for (const OldFloor& floor : fits_.floors()) {
        if (MayBeOne(floor.id, fits_.places()[i].floor))
          searches.push_back({&fits_.places()[i], &floor, {}});
      }
    }
    ForEach(searches.size(), matcher_.threads,
            [&](std::size_t i) { searches[i].fit = Look(*searches[i].place, *searches[i].floor); });
    std::map<const Place*, double> best;
    for (const Search& search : searches) {
      if (search.fit) best[search.place] = std::max(best[search.place], search.fit->score);
    }
    std::vector<Guess> guesses;
    for (const Search& search : searches) {
      if (!search.fit || search.fit->score < best[search.place] - kAlike) continue;
      Guess guess;
      guess.older_floor_of = PairingFrom(search.floor->id, search.place->floor);
      guess.T_older_newer = search.fit->T_world_place * Inverse(search.place->T_world_place);
      const auto same = std::find_if(guesses.begin(), guesses.end(), [&](const Guess& known) {
        return known.older_floor_of == guess.older_floor_of &&
               AreNear(known.T_older_newer, guess.T_older_newer, search.place->T_world_place);
      });
      Guess& counted = same == guesses.end() ? guesses.emplace_back(std::move(guess)) : *same;
      ++counted.votes;
    }
    std::stable_sort(guesses.begin(), guesses.end(),
                     [](const Guess& a, const Guess& b) { return a.votes > b.votes; });
    if (guesses.size() > kMostGuesses) guesses.resize(kMostGuesses);
    return guesses;
  }

  // About a place: a small turn is a long way far off.
  static bool AreNear(const Pose2& T_one, const Pose2& T_other, const Pose2& T_world_place) {
    return Distance(T_one * T_world_place, T_other * T_world_place) < kSameShiftM &&
           std::abs(WrapAngle(T_one.theta - T_other.theta)) < DegToRad(kSameTurnDeg);
  }

  // A level is seen whole where its robot went: what the older one saw from afar alone, through a
  // door, across a hall, contradicts nothing.
  bool Speaks(const PlaceFit& fit, FloorId older) const {
    return !question_.prior || fit.score >= joins_.min_score ||
           fits_.WasPassed(older, fit.T_world_place);
  }

  // Finds every place near where the guess puts it, and the guess anew from all of those.
  void LookAt(Guess& guess) const {
    constexpr int kRounds = 3;
    constexpr std::size_t kFewPlaces = 24;
    constexpr std::size_t kLeastAgreeing = 2;
    constexpr double kWithinM = 2.0;  // floors bend, and the guess comes from one place
    // Most guesses are wrong, which a few places tell.
    const std::size_t few = std::max<std::size_t>(1, fits_.places().size() / kFewPlaces);
    for (int round = 0; round < kRounds; ++round) {
      if (round == 1) PairOpenFloors(guess);
      const std::size_t step = round == 0 ? few : 1;
      std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
      std::vector<std::size_t> fitting;
      std::vector<PlaceFit> fits(fits_.places().size());
      guess.score_of_place.assign(fits_.places().size(), std::nullopt);
      for (std::size_t i = 0; i < fits_.places().size(); i += step) {
        const auto older = guess.older_floor_of.find(fits_.places()[i].floor);
        if (older == guess.older_floor_of.end()) continue;
        const std::optional<PlaceFit> fit =
            fits_.FitOf(fits_.places()[i], older->second, guess.T_older_newer, kWithinM);
        if (!fit || !Speaks(*fit, older->second)) continue;
        guess.score_of_place[i] = fit->score;
        fits[i] = *fit;
        if (fit->score < joins_.min_score) continue;
        fitting.push_back(i);
        pairs.emplace_back(fit->T_world_place.Translation(),
                           fits_.places()[i].T_world_place.Translation());
      }
      guess.within =
          static_cast<int>(std::count_if(guess.score_of_place.begin(), guess.score_of_place.end(),
                                         [](const auto& score) { return score.has_value(); }));
      constexpr std::size_t kLeastToAlign = 3;
      if (pairs.size() >= kLeastToAlign && fits_.SpreadOf(fitting) > joins_.min_spread_m) {
        guess.T_older_newer = AlignRigidly(pairs);
      }
      std::vector<std::size_t> agreeing;
      for (const std::size_t i : fitting) {
        const bool agrees = Distance(guess.T_older_newer * fits_.places()[i].T_world_place,
                                     fits[i].T_world_place) <= joins_.agree_m;
        if (agrees) agreeing.push_back(i);
      }
      if (round == 0 && agreeing.size() < kLeastAgreeing) return;
      guess.fitting = static_cast<int>(agreeing.size());
      guess.spread_m = fits_.SpreadOf(agreeing);
    }
    guess.is_valid = guess.fitting >= joins_.min_places &&
                     guess.fitting >= joins_.min_share * guess.within &&
                     guess.spread_m >= joins_.min_spread_m;
  }

  // Floors that heights do not tell: the older floor that most of their places fit.
  void PairOpenFloors(Guess& guess) const {
    std::map<FloorId, std::vector<const Place*>> open;
    for (const Place& place : fits_.places()) {
      if (IsOpen(guess, place.floor)) open[place.floor].push_back(&place);
    }
    for (const auto& [newer, places] : open) {
      std::optional<FloorId> best;
      int most = joins_.min_places - 1;
      for (const OldFloor& floor : fits_.floors()) {
        const bool is_taken =
            std::any_of(guess.older_floor_of.begin(), guess.older_floor_of.end(),
                        [&](const auto& pair) { return pair.second == floor.id; });
        if (is_taken || !MayBeOne(floor.id, newer)) continue;
        int within = 0;
        int fitting = 0;
        for (const Place* place : places) {
          const auto fit = fits_.FitOf(*place, floor.id, guess.T_older_newer, joins_.agree_m);
          within += fit ? 1 : 0;
          fitting += fit && fit->score >= joins_.min_score ? 1 : 0;
        }
        if (fitting <= most || fitting < joins_.min_share * within) continue;
        most = fitting;
        best = floor.id;
      }
      if (best) guess.older_floor_of[newer] = *best;
    }
  }

  // Places that fit the one clearly better, less those that fit the other clearly better; of those
  // that both speak of.
  int LeadOf(const Guess& best, const Guess& other, int* shared) const {
    int lead = 0;
    *shared = 0;
    for (std::size_t i = 0; i < fits_.places().size(); ++i) {
      if (!best.score_of_place[i] || !other.score_of_place[i]) continue;
      ++*shared;
      const double difference = *best.score_of_place[i] - *other.score_of_place[i];
      lead += difference > joins_.clear_lead ? 1 : difference < -joins_.clear_lead ? -1 : 0;
    }
    return lead;
  }

  bool IsSame(const Guess& one, const Guess& other) const {
    if (one.older_floor_of != other.older_floor_of) return false;
    return std::all_of(fits_.places().begin(), fits_.places().end(), [&](const Place& place) {
      return one.older_floor_of.count(place.floor) == 0 ||
             AreNear(one.T_older_newer, other.T_older_newer, place.T_world_place);
    });
  }

  static std::string Count(const Guess& guess) {
    return std::to_string(guess.fitting) + " of " + std::to_string(guess.within) + " places";
  }

  PieceSearchResult Decide(std::vector<Guess>& guesses) const {
    const auto sum = [](const Guess& guess) {
      double all = 0.0;
      for (const auto& score : guess.score_of_place) all += score.value_or(0.0);
      return all;
    };
    std::stable_sort(guesses.begin(), guesses.end(), [&](const Guess& a, const Guess& b) {
      return std::make_tuple(a.is_valid, a.fitting, sum(a)) >
             std::make_tuple(b.is_valid, b.fitting, sum(b));
    });
    const Guess& best = guesses.front();
    if (!best.is_valid) {
      return {std::nullopt, "its places do not agree: at best " + Count(best) + " fit alike", {}};
    }
    std::vector<const Guess*> ways{&best};
    for (std::size_t i = 1; i < guesses.size(); ++i) {
      const Guess& other = guesses[i];
      const auto is_same = [&](const Guess* way) { return IsSame(*way, other); };
      if (!other.is_valid || std::any_of(ways.begin(), ways.end(), is_same)) continue;
      int shared = 0;
      const int lead = LeadOf(best, other, &shared);
      const bool is_behind = shared > 0 ? 2 * lead >= shared && lead >= joins_.min_places
                                        : 2 * other.fitting < best.fitting;
      if (!is_behind) ways.push_back(&other);
    }
    PieceSearchResult result;
    for (const Guess* way : ways) {
      result.ways.push_back({way->T_older_newer, way->older_floor_of, way->fitting, way->within});
    }
    if (ways.size() == 1) {
      result.placement = result.ways.front();
      result.reason = Count(best) + " fit";
    } else {
      result.reason = "it fits in more than one way: " + Count(best) + " fit one, " +
                      Count(*ways[1]) + " another";
    }
    return result;
  }

  const BuildingMap& map_;
  const PieceQuestion& question_;
  const MatcherOptions& matcher_;
  const DriveJoinOptions& joins_;
  PlaceFits fits_;
};

}  // namespace

PieceSearchResult FindPiece(const BuildingMap& map, const PieceQuestion& question,
                            const DriveJoinOptions& options, const MatcherOptions& matcher) {
  return PieceFinder(map, question, options, matcher).Find();
}

PieceSearchResult FindPiece(const BuildingMap& map, const std::vector<std::size_t>& older,
                            const std::vector<std::size_t>& newer, const DriveJoinOptions& options,
                            const MatcherOptions& matcher) {
  return FindPiece(map, {PartOfDrives(map, older), PartOfDrives(map, newer), {}, std::nullopt},
                   options, matcher);
}

}  // namespace masked_mapper
