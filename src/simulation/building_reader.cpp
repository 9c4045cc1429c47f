// SPDX-License-Identifier: BSD-3-Clause
#include "building_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <istream>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

// A file may come from anyone: bounds far above any building.
constexpr std::size_t kLongestLine = 65'536;
constexpr std::size_t kMaxFloors = 1'000;
constexpr std::size_t kMaxSegments = 2'000'000;
constexpr std::size_t kMaxWayPoints = 5'000;    // per floor
constexpr std::size_t kMaxPassages = 20'000;    // per floor
constexpr std::size_t kMaxConnections = 1'000;  // elevators, and stairs

class BuildingReader {
 public:
  explicit BuildingReader(const std::string& name) : name_(name) {
    building_.name = std::filesystem::path(name).stem().string();
  }

  Building Read(std::istream& text) {
    std::string line;
    while (NextLine(text, line)) {
      ++line_;
      Split(line);
      if (!words_.empty()) ReadItem();
    }
    line_ = 0;
    if (building_.floors.empty()) Fail("no floor in it");
    Resolve();
    SortFloors();
    return std::move(building_);
  }

 private:
  struct NamedStop {
    std::size_t line = 0;
    std::size_t floor = 0;
    std::string connection;
    std::string way_point;
    enum { kStop, kFoot, kHead } kind = kStop;
  };

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(name_ + (line_ > 0 ? ":" + std::to_string(line_) : "") + ": " + what);
  }

  bool NextLine(std::istream& text, std::string& line) {
    line.clear();
    for (int c = text.get(); c != std::istream::traits_type::eof(); c = text.get()) {
      if (c == '\n') return true;
      if (c == 0) {
        ++line_;
        Fail("this is no text");
      }
      line.push_back(static_cast<char>(c));
      if (line.size() > kLongestLine) {
        ++line_;
        Fail("the line is too long");
      }
    }
    return !line.empty();
  }

  void Split(const std::string& line) {
    words_.clear();
    const std::string_view text = std::string_view(line).substr(0, line.find('#'));
    std::size_t at = 0;
    while (true) {
      at = text.find_first_not_of(" \t\r", at);
      if (at == std::string_view::npos) return;
      const std::size_t end = std::min(text.find_first_of(" \t\r", at), text.size());
      words_.emplace_back(text.substr(at, end - at));
      at = end;
    }
  }

  double Number(std::size_t word) const {
    const std::string& text = words_[word];
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      Fail("'" + text + "' is not a number");
    }
    return value;
  }

  void Expect(bool fits, const char* form) const {
    if (!fits) Fail(std::string("expected '") + form + "'");
  }

  FloorPlan& OnFloor() {
    if (building_.floors.empty()) Fail("'" + words_[0] + "' before the first 'floor'");
    return building_.floors.back();
  }

  std::size_t WayPointCalled(const FloorPlan& floor, const std::string& name) const {
    const auto found =
        std::find_if(floor.way_points.begin(), floor.way_points.end(),
                     [&](const WayPoint& way_point) { return way_point.name == name; });
    if (found == floor.way_points.end()) {
      Fail("floor " + floor.label + " has no point '" + name + "'");
    }
    return static_cast<std::size_t>(found - floor.way_points.begin());
  }

  std::size_t FloorCalled(const std::string& label) const {
    const auto found = std::find_if(building_.floors.begin(), building_.floors.end(),
                                    [&](const FloorPlan& floor) { return floor.label == label; });
    if (found == building_.floors.end()) Fail("there is no floor '" + label + "'");
    return static_cast<std::size_t>(found - building_.floors.begin());
  }

  void ReadItem() {
    const std::string& item = words_[0];
    for (const auto& [name, surface] : kSurfaces) {
      if (item == name) return ReadPolyline(surface);
    }
    if (item == "building") return ReadName();
    if (item == "floor") return ReadFloor();
    if (item == "box") return ReadBox();
    if (item == "overhead") return ReadOverhead();
    if (item == "point") return ReadPoint();
    if (item == "corridor") return ReadPassages(true);
    if (item == "way") return ReadPassages(false);
    if (item == "elevator") return ReadElevator();
    if (item == "stairs") return ReadStairs();
    if (item == "stop") return ReadStop(NamedStop::kStop);
    if (item == "foot") return ReadStop(NamedStop::kFoot);
    if (item == "head") return ReadStop(NamedStop::kHead);
    if (item == "start") return ReadStart();
    if (item == "visit") return ReadVisits();
    if (item == "rest") return ReadRest();
    Fail("unknown item '" + item.substr(0, 40) + "'" +
         DidYouMean(item.substr(0, 40),
                    {"building", "floor", "wall", "glass", "door", "furniture", "box", "overhead",
                     "point", "corridor", "way", "elevator", "stairs", "stop", "foot", "head",
                     "start", "visit", "rest"}));
  }

  void ReadName() {
    Expect(words_.size() == 2, "building NAME");
    building_.name = words_[1];
  }

  void ReadFloor() {
    Expect(words_.size() == 3, "floor LABEL ELEVATION");
    if (building_.floors.size() >= kMaxFloors) Fail("more than 1000 floors");
    FloorPlan floor;
    floor.label = words_[1];
    floor.elevation = Number(2);
    building_.floors.push_back(floor);
  }

  void AddSegment(const Segment& segment) {
    if (++segments_ > kMaxSegments) Fail("more than 2000000 segments");
    OnFloor().segments.push_back(segment);
  }

  void ReadPolyline(Surface surface) {
    OnFloor();
    if (words_.size() < 5 || words_.size() % 2 == 0) {
      Fail("expected '" + words_[0] + " X1 Y1 X2 Y2 ...', found " +
           std::to_string(words_.size() - 1) + " numbers");
    }
    for (std::size_t w = 3; w < words_.size(); w += 2) {
      AddSegment({{Number(w - 2), Number(w - 1)}, {Number(w), Number(w + 1)}, surface});
    }
  }

  void ReadBox() {
    Expect(words_.size() == 6, "box X Y THETA_DEG LENGTH WIDTH");
    const Pose2 T_building_box{Number(1), Number(2), DegToRad(Number(3))};
    const double x = 0.5 * Number(4);
    const double y = 0.5 * Number(5);
    const std::array<Eigen::Vector2d, 4> corners{
        T_building_box * Eigen::Vector2d(-x, -y), T_building_box * Eigen::Vector2d(x, -y),
        T_building_box * Eigen::Vector2d(x, y), T_building_box * Eigen::Vector2d(-x, y)};
    for (std::size_t e = 0; e < 4; ++e) {
      AddSegment({corners[e], corners[(e + 1) % 4], Surface::kFurniture});
    }
  }

  void ReadOverhead() {
    Expect(words_.size() == 8, "overhead X Y THETA_DEG LENGTH WIDTH LOW HIGH");
    if (++segments_ > kMaxSegments) Fail("more than 2000000 segments");
    OnFloor().overhead.push_back(
        {{Number(1), Number(2), DegToRad(Number(3))}, Number(4), Number(5), Number(6), Number(7)});
  }

  void ReadPoint() {
    Expect(words_.size() == 4, "point NAME X Y");
    FloorPlan& floor = OnFloor();
    if (floor.way_points.size() >= kMaxWayPoints) Fail("more than 5000 points on a floor");
    floor.way_points.push_back({words_[1], {Number(2), Number(3)}});
  }

  void ReadPassages(bool must_visit) {
    Expect(words_.size() >= 3, must_visit ? "corridor POINT POINT ..." : "way POINT POINT ...");
    FloorPlan& floor = OnFloor();
    for (std::size_t w = 2; w < words_.size(); ++w) {
      if (floor.passages.size() >= kMaxPassages) Fail("more than 20000 passages on a floor");
      floor.passages.push_back(
          {WayPointCalled(floor, words_[w - 1]), WayPointCalled(floor, words_[w]), must_visit});
    }
  }

  void ReadElevator() {
    Expect(words_.size() == 8, "elevator NAME X Y THETA_DEG DEPTH WIDTH DOOR_WIDTH");
    if (building_.elevators.size() >= kMaxConnections) Fail("more than 1000 elevators");
    Elevator elevator;
    elevator.name = words_[1];
    elevator.T_building_cab = {Number(2), Number(3), DegToRad(Number(4))};
    elevator.depth = Number(5);
    elevator.width = Number(6);
    elevator.door_width = Number(7);
    building_.elevators.push_back(elevator);
  }

  void ReadStairs() {
    Expect(words_.size() >= 2 && words_.size() % 2 == 0, "stairs NAME X1 Y1 X2 Y2 ...");
    if (building_.stairs.size() >= kMaxConnections) Fail("more than 1000 stairs");
    Stairs stairs;
    stairs.name = words_[1];
    for (std::size_t w = 2; w < words_.size(); w += 2) {
      stairs.way.emplace_back(Number(w), Number(w + 1));
    }
    building_.stairs.push_back(stairs);
  }

  void ReadStop(decltype(NamedStop::kind) kind) {
    Expect(words_.size() == 3, kind == NamedStop::kStop   ? "stop ELEVATOR POINT"
                               : kind == NamedStop::kFoot ? "foot STAIRS POINT"
                                                          : "head STAIRS POINT");
    OnFloor();
    if (stops_.size() >= kMaxFloors * kMaxConnections / 10) Fail("more than 100000 stops");
    stops_.push_back({line_, building_.floors.size() - 1, words_[1], words_[2], kind});
  }

  void ReadStart() {
    Expect(words_.size() == 3, "start FLOOR POINT");
    start_line_ = line_;
    start_ = {words_[1], words_[2]};
  }

  void ReadVisits() {
    Expect(words_.size() >= 2, "visit FLOOR ...");
    visit_line_ = line_;
    visits_.assign(words_.begin() + 1, words_.end());
  }

  void ReadRest() {
    Expect(words_.size() == 2, "rest SECONDS_PER_METRE");
    building_.usual_tour.rest_per_metre = Number(1);
  }

  template <typename Connection>
  Connection& Called(std::vector<Connection>& connections, const std::string& name,
                     const char* kind) const {
    const auto found = std::find_if(connections.begin(), connections.end(),
                                    [&](const Connection& c) { return c.name == name; });
    if (found == connections.end()) Fail(std::string("there is no ") + kind + " '" + name + "'");
    return *found;
  }

  /// Names to indices, once all are known.
  void Resolve() {
    std::map<std::string, int> ends;  // stairs: 1 foot, 2 head
    for (const NamedStop& stop : stops_) {
      line_ = stop.line;
      const Landing landing{stop.floor,
                            WayPointCalled(building_.floors[stop.floor], stop.way_point)};
      if (stop.kind == NamedStop::kStop) {
        Called(building_.elevators, stop.connection, "elevator").landings.push_back(landing);
        continue;
      }
      Stairs& stairs = Called(building_.stairs, stop.connection, "stairs");
      const int end = stop.kind == NamedStop::kFoot ? 1 : 2;
      if ((ends[stairs.name] & end) != 0) Fail("stairs " + stairs.name + " have this end already");
      ends[stairs.name] |= end;
      (end == 1 ? stairs.lower : stairs.upper) = landing;
    }
    line_ = 0;
    for (const Stairs& stairs : building_.stairs) {
      if (ends[stairs.name] != 3) Fail("stairs " + stairs.name + " need a 'foot' and a 'head'");
    }
    if (start_) {
      line_ = start_line_;
      building_.usual_tour.start_floor = FloorCalled(start_->first);
      building_.usual_tour.start_way_point =
          WayPointCalled(building_.floors[building_.usual_tour.start_floor], start_->second);
    }
    line_ = visit_line_;
    for (const std::string& label : visits_) {
      building_.usual_tour.visits.push_back(FloorCalled(label));
    }
    line_ = 0;
  }

  /// Floors may be written in any order.
  void SortFloors() {
    std::vector<std::size_t> order(building_.floors.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return building_.floors[a].elevation < building_.floors[b].elevation;
    });
    std::vector<std::size_t> place(order.size());
    std::vector<FloorPlan> floors;
    for (std::size_t i = 0; i < order.size(); ++i) {
      place[order[i]] = i;
      floors.push_back(std::move(building_.floors[order[i]]));
    }
    building_.floors = std::move(floors);
    for (Elevator& elevator : building_.elevators) {
      for (Landing& landing : elevator.landings) landing.floor = place[landing.floor];
    }
    for (Stairs& stairs : building_.stairs) {
      stairs.lower.floor = place[stairs.lower.floor];
      stairs.upper.floor = place[stairs.upper.floor];
    }
    building_.usual_tour.start_floor = place[building_.usual_tour.start_floor];
    for (std::size_t& floor : building_.usual_tour.visits) floor = place[floor];
  }

  std::string name_;
  std::size_t line_ = 0;
  std::vector<std::string> words_;
  Building building_;
  std::size_t segments_ = 0;
  std::vector<NamedStop> stops_;
  std::size_t start_line_ = 0;
  std::optional<std::pair<std::string, std::string>> start_;
  std::size_t visit_line_ = 0;
  std::vector<std::string> visits_;
};

}  // namespace

Building ReadBuildingText(std::istream& text, const std::string& name) {
  return BuildingReader(name).Read(text);
}

}  // namespace masked_mapper
