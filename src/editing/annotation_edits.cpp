// SPDX-License-Identifier: BSD-3-Clause
#include "annotation_edits.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "masked_mapper/geometry/polygon.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/text/enum_names.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

/// Clouds are in single precision, which is a centimetre there.
constexpr double kFarthestM = 1e5;

void RequireNear(const Eigen::Vector2d& point, const EditLine& edit) {
  if (point.cwiseAbs().maxCoeff() <= kFarthestM) return;
  edit.Fail(
      "coordinates must be within 100 km, clouds lose centimetres beyond: take an offset off");
}

Eigen::Vector2d PointOf(const std::vector<double>& numbers, const EditLine& edit) {
  Eigen::Vector2d point(numbers[0], numbers[1]);
  RequireNear(point, edit);
  return point;
}

}  // namespace

FloorId FloorOfEdit(const std::string& label, const EditLine& edit, const BuildingMap& map) {
  const std::vector<Floor>& floors = map.graph.floors();
  const auto found = std::find_if(floors.begin(), floors.end(),
                                  [&](const Floor& floor) { return floor.label == label; });
  if (found == floors.end()) {
    std::string all;
    for (const Floor& known : floors) all += (all.empty() ? "" : ", ") + known.label;
    edit.Fail("the map has no floor `" + label + "`, it has " + all);
  }
  return static_cast<FloorId>(found - floors.begin());
}

bool IsName(const std::string& name) {
  const bool is_word = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  });
  return is_word && !name.empty() && name != "." && name != ".." && name.size() <= 100;
}

AnnotationEdits::AnnotationEdits(const BuildingMap& before) {
  for (const Node& node : before.graph.nodes()) {
    T_world_robot_before_.push_back(node.T_world_robot);
  }
}

std::string AnnotationEdits::NamePlaces(EditLine& edit, BuildingMap& map) const {
  std::string names;
  for (const std::string& name : edit.FieldNames()) {
    const EditLine::FloorPoint point = edit.PointOnFloor(name);
    if (!IsName(name)) edit.Fail("a place's name is made of letters, digits, `_`, `.` and `-`");
    RequireNear(point.at, edit);
    const NamedPlace place{name, FloorOfEdit(point.label, edit, map), point.at};
    const auto known = std::find_if(map.places.begin(), map.places.end(),
                                    [&](const NamedPlace& other) { return other.name == name; });
    if (known == map.places.end()) {
      map.places.push_back(place);
    } else {
      *known = place;
    }
    names += (names.empty() ? "" : ", ") + name;
  }
  if (names.empty()) edit.Fail("places: expected name: [floor, x, y]");
  return "named places: " + names;
}

std::string AnnotationEdits::Draw(AreaKind kind, EditLine& edit, BuildingMap& map) const {
  const std::string label = edit.Word("floor");
  Area area;
  area.kind = kind;
  area.corners_in_world = edit.Points("area");
  edit.RequireAllTaken();
  area.floor = FloorOfEdit(label, edit, map);
  for (const Eigen::Vector2d& corner : area.corners_in_world) RequireNear(corner, edit);
  const auto moments = ComputePolygonMoments(area.corners_in_world);
  if (!moments) edit.Fail(edit.what() + ": area must have three corners that are not in a line");
  map.areas.push_back(std::move(area));
  return std::string(kind == AreaKind::kKeepOut ? "kept out of " : "walls erased in ") +
         FixedText(moments->area, 1) + " m2 of floor " + label;
}

std::string AnnotationEdits::Anchor(EditLine& edit, const BuildingMap& map) {
  const std::string label = edit.Word("floor");
  KnownPoint point;
  point.at_in_world = PointOf(edit.Numbers("at", 2), edit);
  point.at_in_site = PointOf(edit.Numbers("is", 2), edit);
  edit.RequireAllTaken();
  point.floor = FloorOfEdit(label, edit, map);
  anchors_.push_back(point);
  return "a known point on floor " + label;
}

void AnnotationEdits::RenameFloors(const std::function<FloorId(FloorId)>& renamed) {
  for (KnownPoint& anchor : anchors_) anchor.floor = renamed(anchor.floor);
}

Eigen::Vector2d AnnotationEdits::Carried(FloorId floor, const Eigen::Vector2d& point,
                                         const BuildingMap& map) const {
  std::optional<std::size_t> nearest;
  double smallest = 0.0;
  for (std::size_t i = 0; i < T_world_robot_before_.size(); ++i) {
    if (map.graph.nodes()[i].floor != floor) continue;
    const double off = (T_world_robot_before_[i].Translation() - point).norm();
    if (nearest && off >= smallest) continue;
    nearest = i;
    smallest = off;
  }
  if (!nearest) return point;
  return map.graph.nodes()[*nearest].T_world_robot *
         (Inverse(T_world_robot_before_[*nearest]) * point);
}

void AnnotationEdits::Carry(BuildingMap& map) {
  for (NamedPlace& place : map.places) {
    place.at_in_world = Carried(place.floor, place.at_in_world, map);
  }
  for (Area& area : map.areas) {
    for (Eigen::Vector2d& corner : area.corners_in_world) {
      corner = Carried(area.floor, corner, map);
    }
  }
  for (KnownPoint& anchor : anchors_) {
    anchor.at_in_world = Carried(anchor.floor, anchor.at_in_world, map);
  }
}

void AnnotationEdits::MoveToAnchors(BuildingMap& map) const {
  if (anchors_.empty()) return;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
  for (const KnownPoint& anchor : anchors_) {
    pairs.emplace_back(anchor.at_in_site, anchor.at_in_world);
  }
  const Pose2 T_site_world = AlignRigidly(pairs);
  MoveMap(T_site_world, map);
  std::string text = "edited: in the site's frame, moved by " + FixedText(T_site_world.x, 2) +
                     ", " + FixedText(T_site_world.y, 2) + " m and turned by " +
                     FixedText(RadToDeg(T_site_world.theta), 2) + " deg";
  if (anchors_.size() == 1) {
    text += "; one known point says nothing of the turn";
  } else {
    text += "; known points are off by ";
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double off = (T_site_world * pairs[i].second - pairs[i].first).norm();
      text += (i == 0 ? "" : ", ") + FixedText(off, 3);
    }
    text += " m";
  }
  map.warnings.push_back(std::move(text));
}

}  // namespace masked_mapper
