// SPDX-License-Identifier: BSD-3-Clause
#include "floor_plan_file.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "masked_mapper/text/enum_names.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

double Millimetres(double metres) { return std::round(metres * 1000.0) / 1000.0; }

Json PointJson(const Eigen::Vector2d& point) {
  return {Millimetres(point.x()), Millimetres(point.y())};
}

class Features {
 public:
  explicit Features(const BuildingMap& map) : map_(map) {}

  void Add(FloorId floor, const std::string& kind, const std::string& name, const char* type,
           Json coordinates) {
    Json properties = {{"floor", map_.graph.floor(floor).label},
                       {"elevation_m", Millimetres(map_.graph.floor(floor).elevation)},
                       {"kind", kind}};
    if (!name.empty()) properties["name"] = name;
    features_.push_back({{"type", "Feature"},
                         {"properties", std::move(properties)},
                         {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}});
  }

  std::string Text() const {
    // No `crs`: these are metres in the map's own frame, nowhere on Earth.
    const Json collection = {
        {"type", "FeatureCollection"}, {"name", "floor_plans"}, {"features", features_}};
    return collection.dump(1) + "\n";
  }

 private:
  const BuildingMap& map_;
  Json features_ = Json::array();
};

/// With y up, as the picture is drawn within a group that is turned over.
std::string SvgPoint(const Eigen::Vector2d& point) {
  return FixedText(point.x(), 3) + " " + FixedText(point.y(), 3);
}

class SvgFloor {
 public:
  SvgFloor(const BuildingMap& map, const PlanLayer& layer, const std::vector<Crossing>& crossings)
      : map_(map), layer_(layer), crossings_(crossings) {}

  std::string Text() const {
    const std::string& label = map_.graph.floor(layer_.floor).label;
    std::string text = "<g id=\"floor_" + label + "\" inkscape:groupmode=\"layer\"" +
                       " inkscape:label=\"" + label + "\" transform=\"scale(1,-1)\">\n";
    for (const Area& area : map_.areas) {
      if (area.floor != layer_.floor || area.kind != AreaKind::kKeepOut) continue;
      text += "<path class=\"keep_out\" d=\"M";
      for (const Eigen::Vector2d& corner : area.corners_in_world) text += " " + SvgPoint(corner);
      text += " Z\"/>\n";
    }
    text += "<path class=\"wall\" d=\"";
    for (const WallLine& wall : layer_.walls) {
      text += "M " + SvgPoint(wall.a) + " L " + SvgPoint(wall.b) + "\n";
    }
    text += "\"/>\n" + Marks() + "</g>\n";
    return text;
  }

 private:
  std::string Marks() const {
    std::string text;
    for (const Crossing& crossing : crossings_) {
      for (const Stop& stop : crossing.stops) {
        if (stop.floor == layer_.floor) {
          text += Mark(Name(crossing.kind), stop.T_world_robot.Translation(), Name(crossing.kind));
        }
      }
    }
    for (const NamedPlace& place : map_.places) {
      if (place.floor == layer_.floor) text += Mark("place", place.at_in_world, place.name);
    }
    return text;
  }

  static std::string Mark(const std::string& kind, const Eigen::Vector2d& at,
                          const std::string& title) {
    return "<circle class=\"" + kind + "\" cx=\"" + FixedText(at.x(), 3) + "\" cy=\"" +
           FixedText(at.y(), 3) + "\" r=\"0.25\"><title>" + title + "</title></circle>\n";
  }

  const BuildingMap& map_;
  const PlanLayer& layer_;
  const std::vector<Crossing>& crossings_;
};

}  // namespace

std::string SvgText(const BuildingMap& map, const std::vector<PlanLayer>& layers,
                    const std::vector<Crossing>& crossings) {
  constexpr double kMargin = 1.0;              // m
  constexpr double kMillimetresPerMetre = 10;  // 1:100
  Eigen::Vector2d low(0.0, 0.0);
  Eigen::Vector2d high(0.0, 0.0);
  bool is_first = true;
  for (const PlanLayer& layer : layers) {
    for (const WallLine& wall : layer.walls) {
      if (is_first) low = high = wall.a;
      is_first = false;
      low = low.cwiseMin(wall.a).cwiseMin(wall.b);
      high = high.cwiseMax(wall.a).cwiseMax(wall.b);
    }
  }
  low.array() -= kMargin;
  high.array() += kMargin;
  const Eigen::Vector2d size = high - low;
  std::string text =
      "<svg xmlns=\"http://www.w3.org/2000/svg\""
      " xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" +
      FixedText(size.x() * kMillimetresPerMetre, 2) + "mm\" height=\"" +
      FixedText(size.y() * kMillimetresPerMetre, 2) + "mm\" viewBox=\"" + FixedText(low.x(), 3) +
      " " + FixedText(-high.y(), 3) + " " + FixedText(size.x(), 3) + " " + FixedText(size.y(), 3) +
      "\">\n<style>.wall{fill:none;stroke:#000;stroke-width:0.05;stroke-linecap:round}"
      ".keep_out{fill:#d33;fill-opacity:0.3}.place{fill:#06c}.elevator{fill:#393}"
      ".stairs{fill:#c60}</style>\n";
  for (const PlanLayer& layer : layers) text += SvgFloor(map, layer, crossings).Text();
  return text + "</svg>\n";
}

std::string GeoJsonText(const BuildingMap& map, const std::vector<PlanLayer>& layers,
                        const std::vector<Crossing>& crossings) {
  Features features(map);
  for (const PlanLayer& layer : layers) {
    for (const WallLine& wall : layer.walls) {
      features.Add(layer.floor, "wall", "", "LineString",
                   Json::array({PointJson(wall.a), PointJson(wall.b)}));
    }
    for (const Area& area : map.areas) {
      if (area.floor != layer.floor || area.kind != AreaKind::kKeepOut) continue;
      Json ring = Json::array();
      for (const Eigen::Vector2d& corner : area.corners_in_world) ring.push_back(PointJson(corner));
      ring.push_back(ring.front());
      features.Add(layer.floor, "keep_out", "", "Polygon", Json::array({std::move(ring)}));
    }
    for (const NamedPlace& place : map.places) {
      if (place.floor != layer.floor) continue;
      features.Add(layer.floor, "place", place.name, "Point", PointJson(place.at_in_world));
    }
    for (const Crossing& crossing : crossings) {
      for (const Stop& stop : crossing.stops) {
        if (stop.floor != layer.floor) continue;
        features.Add(layer.floor, Name(crossing.kind), "", "Point",
                     PointJson(stop.T_world_robot.Translation()));
      }
    }
  }
  return features.Text();
}

}  // namespace masked_mapper
