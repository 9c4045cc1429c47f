// SPDX-License-Identifier: BSD-3-Clause
#include "annotation_rows.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "masked_mapper/text/enum_names.hpp"
#include "packed_bytes.hpp"
#include "row_values.hpp"

namespace masked_mapper {

void WriteAnnotations(const BuildingMap& result, const Database& database) {
  Statement insert_place(database, "INSERT INTO places VALUES (?,?,?,?,?)");
  for (std::size_t i = 0; i < result.places.size(); ++i) {
    const NamedPlace& place = result.places[i];
    insert_place.Bind(static_cast<std::int64_t>(i))
        .BindText(place.name)
        .Bind(std::int64_t{place.floor});
    insert_place.Bind(place.at_in_world.x()).Bind(place.at_in_world.y()).Put();
  }
  Statement insert_area(database, "INSERT INTO areas VALUES (?,?,?,?)");
  for (std::size_t i = 0; i < result.areas.size(); ++i) {
    const Area& area = result.areas[i];
    std::string corners;
    for (const Eigen::Vector2d& corner : area.corners_in_world) {
      AppendBytes(corner.x(), corners);
      AppendBytes(corner.y(), corners);
    }
    insert_area.Bind(static_cast<std::int64_t>(i))
        .BindText(Name(area.kind))
        .Bind(std::int64_t{area.floor});
    insert_area.BindBlob(corners).Put();
  }
}

void ReadAnnotations(const Database& database, BuildingMap& map) {
  const std::size_t floors = map.graph.floors().size();
  Statement places(database, "SELECT * FROM places ORDER BY id");
  while (places.Next()) {
    TakeId(places, map.places.size(), "places");
    NamedPlace place;
    place.name = places.Text();
    place.floor = static_cast<FloorId>(TakeBelow(places, floors, "places", "the floor"));
    place.at_in_world.x() = TakeFinite(places, "places");
    place.at_in_world.y() = TakeFinite(places, "places");
    map.places.push_back(std::move(place));
  }
  Statement areas(database, "SELECT * FROM areas ORDER BY id");
  while (areas.Next()) {
    TakeId(areas, map.areas.size(), "areas");
    Area area;
    area.kind = ValueNamed<AreaKind>(areas.Text(), "areas");
    area.floor = static_cast<FloorId>(TakeBelow(areas, floors, "areas", "the floor"));
    std::string_view corners = areas.Blob();
    if (corners.size() % (2 * sizeof(double)) != 0) Malformed("areas", "half a corner");
    while (!corners.empty()) {
      const auto x = TakeNumber<double>(corners);
      const auto y = TakeNumber<double>(corners);
      if (!std::isfinite(x) || !std::isfinite(y)) Malformed("areas", "a corner that cannot be");
      area.corners_in_world.emplace_back(x, y);
    }
    if (area.corners_in_world.size() < 3) Malformed("areas", "an area of fewer than 3 corners");
    map.areas.push_back(std::move(area));
  }
}

}  // namespace masked_mapper
