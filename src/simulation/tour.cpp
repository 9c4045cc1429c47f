// SPDX-License-Identifier: BSD-3-Clause
#include "tour.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "masked_mapper/text/input_error.hpp"
#include "random_generator.hpp"

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTransitCost = 30.0;  // m, what a change of floor counts in shortest ways
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct Link {
  std::size_t to = 0;
  std::size_t passage = 0;
  double length = 0.0;
};
using Links = std::vector<std::vector<Link>>;  // per way-point

Links LinksOf(const FloorPlan& floor) {
  Links links(floor.way_points.size());
  for (std::size_t p = 0; p < floor.passages.size(); ++p) {
    const Passage& passage = floor.passages[p];
    const double length =
        (floor.way_points[passage.to].position - floor.way_points[passage.from].position).norm();
    links[passage.from].push_back({passage.to, p, length});
    links[passage.to].push_back({passage.from, p, length});
  }
  return links;
}

/// Shortest ways from one way-point on its floor. `weights` scale passages; empty: all 1.
struct ShortestWays {
  std::vector<double> distance;
  std::vector<Link>
      back;  ///< the link by which a way-point was reached, `to` is where it came from

  ShortestWays(const Links& links, std::size_t source, const std::vector<double>& weights)
      : distance(links.size(), kInfinity), back(links.size()) {
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[source] = 0.0;
    queue.emplace(0.0, source);
    while (!queue.empty()) {
      const auto [cost, here] = queue.top();
      queue.pop();
      if (cost > distance[here]) continue;
      for (const Link& link : links[here]) {
        const double weight = weights.empty() ? 1.0 : weights[link.passage];
        const double next = cost + weight * link.length;
        if (next >= distance[link.to]) continue;
        distance[link.to] = next;
        back[link.to] = {here, link.passage, link.length};
        queue.emplace(next, link.to);
      }
    }
  }

  /// Links from the source to `target`, in order of going.
  std::vector<Link> To(std::size_t source, std::size_t target) const {
    std::vector<Link> way;
    for (std::size_t here = target; here != source; here = back[here].to) {
      way.push_back({here, back[here].passage, back[here].length});
    }
    std::reverse(way.begin(), way.end());
    return way;
  }
};

/// Pairs way-points so that the sum of distances is small: greedy, then swaps while they help.
std::vector<std::pair<std::size_t, std::size_t>> Pair(const std::vector<std::size_t>& odd,
                                                      const std::vector<ShortestWays>& ways) {
  const auto distance = [&](std::size_t i, std::size_t j) { return ways[i].distance[odd[j]]; };
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<bool> taken(odd.size(), false);
  for (std::size_t count = 0; count < odd.size() / 2; ++count) {
    std::pair<std::size_t, std::size_t> best{kNone, kNone};
    double best_distance = kInfinity;
    for (std::size_t i = 0; i < odd.size(); ++i) {
      for (std::size_t j = i + 1; j < odd.size() && !taken[i]; ++j) {
        if (taken[j] || distance(i, j) >= best_distance) continue;
        best = {i, j};
        best_distance = distance(i, j);
      }
    }
    taken[best.first] = taken[best.second] = true;
    pairs.push_back(best);
  }
  bool improved = true;
  while (improved) {
    improved = false;
    for (std::size_t a = 0; a < pairs.size(); ++a) {
      for (std::size_t b = a + 1; b < pairs.size(); ++b) {
        auto& [a0, a1] = pairs[a];
        auto& [b0, b1] = pairs[b];
        const double now = distance(a0, a1) + distance(b0, b1);
        if (distance(a0, b0) + distance(a1, b1) < now - 1e-9) {
          std::swap(a1, b0);
          improved = true;
        } else if (distance(a0, b1) + distance(a1, b0) < now - 1e-9) {
          std::swap(a1, b1);
          improved = true;
        }
      }
    }
  }
  return pairs;
}

class TourBuilder {
 public:
  TourBuilder(const Building& building, const TourOptions& options)
      : building_(building), options_(options), random_(options.seed, "tour") {
    for (const FloorPlan& floor : building.floors) {
      links_.push_back(LinksOf(floor));
      visited_.emplace_back(floor.passages.size(), false);
    }
    elevator_uses_.assign(building.elevators.size(), 0);
    stairs_uses_.assign(building.stairs.size(), 0);
    here_ = {building.usual_tour.start_floor, building.usual_tour.start_way_point};
    tour_.legs.push_back({here_.floor, {here_.way_point}});
  }

  Tour Build() {
    const std::vector<std::size_t> visits = Visits();
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const bool again = i > 0 && visits[i] == visits[i - 1];
      if (here_.floor != visits[i]) GoToFloor(visits[i]);
      const bool last = i + 1 == visits.size();
      VisitFloor(last ? kNone : visits[i + 1], again, kInfinity);
    }
    VisitWhatIsLeft();
    Lengthen();
    GoTo({building_.usual_tour.start_floor, building_.usual_tour.start_way_point});
    return std::move(tour_);
  }

 private:
  struct Connection {
    Transit transit;
    Landing from;
    Landing to;
  };

  std::vector<std::size_t> Visits() const {
    if (!options_.visits.empty()) return options_.visits;
    if (!building_.usual_tour.visits.empty()) return building_.usual_tour.visits;
    std::vector<std::size_t> visits{building_.usual_tour.start_floor};
    for (std::size_t f = 0; f < building_.floors.size(); ++f) {
      if (f != visits.front()) visits.push_back(f);
    }
    if (visits.size() > 1) visits.push_back(visits.front());
    return visits;
  }

  void Walk(const std::vector<Link>& way) {
    for (const Link& link : way) {
      tour_.legs.back().way_points.push_back(link.to);
      visited_[here_.floor][link.passage] = true;
      length_ += link.length;
      here_.way_point = link.to;
    }
  }

  void WalkTo(std::size_t way_point, const std::vector<double>& weights = {}) {
    Walk(
        ShortestWays(links_[here_.floor], here_.way_point, weights).To(here_.way_point, way_point));
  }

  void Take(const Connection& connection) {
    WalkTo(connection.from.way_point);
    if (connection.transit.kind == Transit::Kind::kElevator) {
      ++elevator_uses_[connection.transit.index];
    } else {
      ++stairs_uses_[connection.transit.index];
    }
    tour_.transits.push_back(connection.transit);
    here_ = connection.to;
    tour_.legs.push_back({here_.floor, {here_.way_point}});
  }

  /// All rides and climbs that begin on a floor.
  std::vector<Connection> ConnectionsFrom(std::size_t floor) const {
    std::vector<Connection> connections;
    for (std::size_t e = 0; e < building_.elevators.size(); ++e) {
      for (const Landing& from : building_.elevators[e].landings) {
        for (const Landing& to : building_.elevators[e].landings) {
          if (from.floor == floor && to.floor != floor) {
            connections.push_back({{Transit::Kind::kElevator, e}, from, to});
          }
        }
      }
    }
    for (std::size_t s = 0; s < building_.stairs.size(); ++s) {
      const Stairs& stairs = building_.stairs[s];
      const Transit transit{Transit::Kind::kStairs, s};
      if (stairs.lower.floor == floor) connections.push_back({transit, stairs.lower, stairs.upper});
      if (stairs.upper.floor == floor) connections.push_back({transit, stairs.upper, stairs.lower});
    }
    return connections;
  }

  /// The least used direct connection to a floor that can be reached from here on this floor.
  std::optional<Connection> ChooseConnection(std::size_t floor) {
    const ShortestWays ways(links_[here_.floor], here_.way_point, {});
    std::vector<Connection> best;
    std::size_t least = kNone;
    for (const Connection& connection : ConnectionsFrom(here_.floor)) {
      if (connection.to.floor != floor) continue;
      if (ways.distance[connection.from.way_point] == kInfinity) continue;
      const std::size_t uses = connection.transit.kind == Transit::Kind::kElevator
                                   ? elevator_uses_[connection.transit.index]
                                   : stairs_uses_[connection.transit.index];
      if (uses < least) {
        least = uses;
        best.clear();
      }
      if (uses == least) best.push_back(connection);
    }
    if (best.empty()) return std::nullopt;
    return best[random_.Below(best.size())];
  }

  /// Drives to the nearest of the way-points for which `is_target` holds, over as many floors as
  /// that takes. Returns whether there is one.
  template <typename IsTarget>
  bool GoToNearest(const IsTarget& is_target) {
    std::vector<std::size_t> first;  // index of a floor's first way-point among all
    std::vector<Landing> all;
    for (std::size_t f = 0; f < building_.floors.size(); ++f) {
      first.push_back(all.size());
      for (std::size_t w = 0; w < building_.floors[f].way_points.size(); ++w) all.push_back({f, w});
    }
    const auto id = [&](const Landing& landing) {
      return first[landing.floor] + landing.way_point;
    };
    std::vector<double> distance(all.size(), kInfinity);
    std::vector<std::size_t> back(all.size(), kNone);
    std::vector<std::optional<Connection>> by(all.size());
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[id(here_)] = 0.0;
    queue.emplace(0.0, id(here_));
    std::size_t target = kNone;
    while (!queue.empty()) {
      // No structured binding: C++17 does not let the lambda below capture one.
      const double cost = queue.top().first;
      const std::size_t at = queue.top().second;
      queue.pop();
      if (cost > distance[at]) continue;
      if (is_target(all[at])) {
        target = at;
        break;
      }
      const auto relax = [&](const Landing& to, double next,
                             const std::optional<Connection>& connection) {
        if (next >= distance[id(to)]) return;
        distance[id(to)] = next;
        back[id(to)] = at;
        by[id(to)] = connection;
        queue.emplace(next, id(to));
      };
      for (const Link& link : links_[all[at].floor][all[at].way_point]) {
        relax({all[at].floor, link.to}, cost + link.length, std::nullopt);
      }
      for (const Connection& connection : ConnectionsFrom(all[at].floor)) {
        if (connection.from.way_point != all[at].way_point) continue;
        relax(connection.to, cost + kTransitCost, connection);
      }
    }
    if (target == kNone) return false;
    std::vector<std::size_t> way;
    for (std::size_t at = target; at != id(here_); at = back[at]) way.push_back(at);
    std::reverse(way.begin(), way.end());
    for (const std::size_t at : way) {
      if (by[at]) {
        Take(*by[at]);
      } else {
        WalkTo(all[at].way_point);
      }
    }
    return true;
  }

  void GoTo(const Landing& target) {
    const bool there = GoToNearest([&](const Landing& landing) {
      return landing.floor == target.floor && landing.way_point == target.way_point;
    });
    assert(there && "CheckBuilding: everything can be reached from the start");
    static_cast<void>(there);
  }

  void GoToFloor(std::size_t floor) {
    if (const std::optional<Connection> direct = next_ ? next_ : ChooseConnection(floor)) {
      next_.reset();
      Take(*direct);
      return;
    }
    GoToNearest([&](const Landing& landing) { return landing.floor == floor; });
  }

  /// Drives what is not yet driven of this floor, or, when there is nothing left, all of it
  /// (`again`) or an excursion, and ends where the way to `next_floor` begins.
  void VisitFloor(std::size_t next_floor, bool again, double budget) {
    next_.reset();
    if (next_floor != kNone && next_floor != here_.floor) next_ = ChooseConnection(next_floor);
    std::size_t end = next_ ? next_->from.way_point : here_.way_point;
    if (next_floor == kNone && here_.floor == building_.usual_tour.start_floor &&
        CanReach(building_.usual_tour.start_way_point)) {
      end = building_.usual_tour.start_way_point;
    }
    const std::vector<bool> wanted = Wanted(again);
    if (std::find(wanted.begin(), wanted.end(), true) != wanted.end()) {
      Cover(wanted, end, budget);
    } else {
      Excursion(end);
    }
  }

  bool CanReach(std::size_t way_point) const {
    return ShortestWays(links_[here_.floor], here_.way_point, {}).distance[way_point] < kInfinity;
  }

  /// The passages of this floor to drive: those that must be and are not yet, or all of them again.
  std::vector<bool> Wanted(bool again) const {
    const FloorPlan& floor = building_.floors[here_.floor];
    const ShortestWays ways(links_[here_.floor], here_.way_point, {});
    std::vector<bool> wanted(floor.passages.size());
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      wanted[p] = floor.passages[p].must_visit && (again || !visited_[here_.floor][p]) &&
                  ways.distance[floor.passages[p].from] < kInfinity;
    }
    return wanted;
  }

  /// A walk over all wanted passages from here to `end` with little driven twice: the wanted
  /// passages, joined where they are apart and doubled along short ways between odd way-points
  /// until an Euler walk exists (the Chinese postman's way, with a good pairing in place of the
  /// best).
  void Cover(const std::vector<bool>& wanted, std::size_t end, double budget) {
    const Links& links = links_[here_.floor];
    const FloorPlan& floor = building_.floors[here_.floor];
    std::vector<Link> edges;  // `to` is one end; the passage knows both
    const auto add = [&](std::size_t passage) {
      const Eigen::Vector2d& a = floor.way_points[floor.passages[passage].from].position;
      const Eigen::Vector2d& b = floor.way_points[floor.passages[passage].to].position;
      edges.push_back({floor.passages[passage].to, passage, (a - b).norm()});
    };
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      if (wanted[p]) add(p);
    }
    for (const std::size_t passage : Joints(wanted, end)) add(passage);

    std::vector<std::size_t> degree(links.size(), 0);
    for (const Link& edge : edges) {
      ++degree[floor.passages[edge.passage].from];
      ++degree[floor.passages[edge.passage].to];
    }
    ++degree[here_.way_point];
    ++degree[end];
    std::vector<std::size_t> odd;
    for (std::size_t w = 0; w < degree.size(); ++w) {
      if (degree[w] % 2 == 1) odd.push_back(w);
    }
    std::vector<ShortestWays> ways;
    for (const std::size_t way_point : odd)
      ways.emplace_back(links, way_point, std::vector<double>{});
    for (const auto& [i, j] : Pair(odd, ways)) {
      for (const Link& link : ways[i].To(odd[i], odd[j])) add(link.passage);
    }
    std::vector<Link> walk = EulerWalk(edges);
    if (budget < kInfinity) {
      double length = 0.0;
      std::size_t keep = 0;
      while (keep < walk.size() && length < budget) length += walk[keep++].length;
      walk.resize(keep);
    }
    Walk(walk);
    if (here_.way_point != end) WalkTo(end);
  }

  /// Passages that join the wanted ones, the place here and `end` to one connected whole.
  std::vector<std::size_t> Joints(const std::vector<bool>& wanted, std::size_t end) const {
    const FloorPlan& floor = building_.floors[here_.floor];
    const Links& links = links_[here_.floor];
    std::vector<std::size_t> joints;
    std::vector<bool> in_use = wanted;
    while (true) {
      std::vector<bool> joined(links.size(), false);
      std::vector<std::size_t> open{here_.way_point};
      joined[here_.way_point] = true;
      while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        for (const Link& link : links[at]) {
          if (!in_use[link.passage] || joined[link.to]) continue;
          joined[link.to] = true;
          open.push_back(link.to);
        }
      }
      std::optional<std::size_t> apart;
      if (!joined[end]) apart = end;
      for (std::size_t p = 0; p < in_use.size() && !apart; ++p) {
        if (in_use[p] && !joined[floor.passages[p].from]) apart = floor.passages[p].from;
      }
      if (!apart) return joints;
      const ShortestWays ways(links, *apart, {});
      std::size_t nearest = here_.way_point;
      for (std::size_t w = 0; w < joined.size(); ++w) {
        if (joined[w] && ways.distance[w] < ways.distance[nearest]) nearest = w;
      }
      for (const Link& link : ways.To(*apart, nearest)) {
        if (in_use[link.passage]) continue;
        in_use[link.passage] = true;
        joints.push_back(link.passage);
      }
    }
  }

  /// Hierholzer's walk over all edges, beginning here; which way is taken at a crossing is drawn,
  /// turning round on the spot only where there is nothing else.
  std::vector<Link> EulerWalk(const std::vector<Link>& edges) {
    const FloorPlan& floor = building_.floors[here_.floor];
    std::vector<std::vector<std::size_t>> at(links_[here_.floor].size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      at[floor.passages[edges[e].passage].from].push_back(e);
      at[floor.passages[edges[e].passage].to].push_back(e);
    }
    std::vector<bool> used(edges.size(), false);
    struct Step {
      std::size_t way_point;
      std::size_t edge;
    };
    std::vector<Step> stack{{here_.way_point, kNone}};
    std::vector<Step> reversed;
    while (!stack.empty()) {
      const Step step = stack.back();
      std::vector<std::size_t> choices;
      std::vector<std::size_t> turns;  // back along the passage just driven
      for (const std::size_t e : at[step.way_point]) {
        if (used[e]) continue;
        const bool turn = step.edge != kNone && edges[e].passage == edges[step.edge].passage;
        (turn ? turns : choices).push_back(e);
      }
      if (choices.empty()) choices = turns;
      if (choices.empty()) {
        reversed.push_back(step);
        stack.pop_back();
        continue;
      }
      const std::size_t e = choices[random_.Below(choices.size())];
      used[e] = true;
      const Passage& passage = floor.passages[edges[e].passage];
      stack.push_back({passage.from == step.way_point ? passage.to : passage.from, e});
    }
    std::vector<Link> walk;
    for (std::size_t i = reversed.size() - 1; i-- > 0;) {
      const Link& edge = edges[reversed[i].edge];
      walk.push_back({reversed[i].way_point, edge.passage, edge.length});
    }
    return walk;
  }

  /// Out to some way-point a while away, and to `end` by another way where there is one.
  void Excursion(std::size_t end) {
    constexpr double kNear = 20.0;  // m
    constexpr double kFar = 80.0;   // m
    const ShortestWays ways(links_[here_.floor], here_.way_point, {});
    std::vector<std::size_t> able;
    for (std::size_t w = 0; w < ways.distance.size(); ++w) {
      if (ways.distance[w] >= kNear && ways.distance[w] <= kFar) able.push_back(w);
    }
    std::vector<double> weights(building_.floors[here_.floor].passages.size(), 1.0);
    if (!able.empty()) {
      const std::size_t target = able[random_.Below(able.size())];
      for (const Link& link : ways.To(here_.way_point, target)) weights[link.passage] = 4.0;
      WalkTo(target);
    }
    WalkTo(end, weights);
  }

  void VisitWhatIsLeft() {
    const auto is_left = [&](const Landing& landing) {
      for (const Link& link : links_[landing.floor][landing.way_point]) {
        if (building_.floors[landing.floor].passages[link.passage].must_visit &&
            !visited_[landing.floor][link.passage]) {
          return true;
        }
      }
      return false;
    };
    while (GoToNearest(is_left)) Cover(Wanted(false), here_.way_point, kInfinity);
  }

  void Lengthen() {
    while (length_ < options_.length) {
      const double before = length_;
      const std::size_t floors = building_.floors.size();
      // Mostly another floor, so that floors are met again and again.
      if (floors > 1 && random_.Chance(0.8)) {
        const std::size_t next = (here_.floor + 1 + random_.Below(floors - 1)) % floors;
        next_.reset();
        GoToFloor(next);
      }
      VisitFloor(here_.floor, true, options_.length - length_);
      if (!(length_ > before)) return;  // a floor without any passage
    }
  }

  const Building& building_;
  const TourOptions& options_;
  RandomGenerator random_;
  std::vector<Links> links_;                // per floor
  std::vector<std::vector<bool>> visited_;  // per floor and passage
  std::vector<std::size_t> elevator_uses_;
  std::vector<std::size_t> stairs_uses_;
  Landing here_;
  std::optional<Connection> next_;  // by which this floor will be left
  double length_ = 0.0;             // m, driven so far
  Tour tour_;
};

}  // namespace

Tour PlanTour(const Building& building, const TourOptions& options) {
  for (const std::size_t floor : options.visits) {
    if (floor >= building.floors.size()) {
      throw InputError("building '" + building.name + "' has no floor number " +
                       std::to_string(floor) + " to visit; it has " +
                       std::to_string(building.floors.size()));
    }
  }
  return TourBuilder(building, options).Build();
}

UsualTour OtherTour(const Building& building, std::uint64_t seed, std::uint64_t tour,
                    const std::vector<std::size_t>& visits) {
  UsualTour other = building.usual_tour;
  if (tour == 1) return other;
  RandomGenerator random(seed, "start of tour " + std::to_string(tour));
  const std::size_t floors = building.floors.size();
  if (!visits.empty()) {
    if (visits.front() >= floors) return other;  // which PlanTour says
    other.start_floor = visits.front();
  } else if (floors > 1) {
    other.start_floor = (other.start_floor + 1 + random.Below(floors - 1)) % floors;
  }
  // On a corridor: somewhere that the usual tour can reach, too.
  std::vector<std::size_t> able;
  for (const Passage& passage : building.floors.at(other.start_floor).passages) {
    if (passage.must_visit) able.push_back(passage.from);
  }
  if (able.empty()) return building.usual_tour;
  other.start_way_point = able[random.Below(able.size())];
  other.visits = {other.start_floor};
  std::vector<std::size_t> rest;
  for (std::size_t f = 0; f < floors; ++f) {
    if (f != other.start_floor) rest.push_back(f);
  }
  while (!rest.empty()) {
    const auto next = rest.begin() + static_cast<std::ptrdiff_t>(random.Below(rest.size()));
    other.visits.push_back(*next);
    rest.erase(next);
  }
  if (floors > 1) other.visits.push_back(other.start_floor);
  return other;
}

double TourLength(const Building& building, const Tour& tour) {
  double length = 0.0;
  for (const TourLeg& leg : tour.legs) {
    const FloorPlan& floor = building.floors[leg.floor];
    for (std::size_t i = 1; i < leg.way_points.size(); ++i) {
      length += (floor.way_points[leg.way_points[i]].position -
                 floor.way_points[leg.way_points[i - 1]].position)
                    .norm();
    }
  }
  return length;
}

}  // namespace masked_mapper
