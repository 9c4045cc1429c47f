// SPDX-License-Identifier: BSD-3-Clause
#include "localization_page.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr double kCell = 0.1;      // m, of the walls that are drawn
constexpr double kDotEvery = 0.2;  // m of way between the points of a line

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Drive in the "
    "map</title>\n"
    "<style>body{font:15px/1.4 sans-serif;margin:1.5em;max-width:1400px}svg{width:100%;height:auto;"
    "max-height:90vh;background:#fff;border:1px solid #ccc}.wall{stroke:#333;fill:none}"
    ".sure{stroke:#0a58ca;fill:none}.later{stroke:#e07b00;fill:none}.change{fill:none;stroke:#"
    "c4008f}"
    ".start{fill:#0a8f3c}.end{fill:#c00}i{display:inline-block;width:1.6em;height:.3em;"
    "vertical-align:middle;margin:0 .3em 0 1em}</style></head><body>\n";

std::string Number(double value) { return FixedText(value, 2); }

std::string WallsOf(const OccupancyGrid& grid) {
  std::string path;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kOccupied) continue;
      const int first = column;
      while (column < grid.width && grid.at(column, row) == Cell::kOccupied) ++column;
      path += "M" + Number(grid.origin_x + first * grid.resolution_m) + " " +
              Number(-(grid.origin_y + (row + 0.5) * grid.resolution_m)) + "h" +
              Number((column - first) * grid.resolution_m);
    }
  }
  return "<path class=\"wall\" stroke-width=\"" + Number(grid.resolution_m) + "\" d=\"" + path +
         "\"/>\n";
}

std::string PointText(const Pose2& pose) { return Number(pose.x) + "," + Number(-pose.y) + " "; }

/// The drive on one floor, as lines of one colour each.
std::string LinesOf(const Localization& drive, FloorId floor, double width) {
  std::string lines;
  std::string points;
  const LocatedScan* before = nullptr;
  const auto end_line = [&] {
    if (before != nullptr && !points.empty()) {
      lines += std::string("<polyline class=\"") + (before->sure ? "sure" : "later") +
               "\" stroke-width=\"" + Number(width) + "\" points=\"" + points + "\"/>\n";
    }
    points.clear();
    before = nullptr;
  };
  for (const LocatedScan& scan : drive.scans) {
    if (!scan.placed || scan.floor != floor) {
      end_line();
      continue;
    }
    constexpr double kLeap = 3.0;  // m
    if (before != nullptr) {
      const double step = Distance(before->T_world_robot.mean, scan.T_world_robot.mean);
      if (step > kLeap || before->sure != scan.sure) {
        end_line();
      } else if (step < kDotEvery) {
        continue;
      }
    }
    points += PointText(scan.T_world_robot.mean);
    before = &scan;
  }
  end_line();
  return lines;
}

std::string MarkOf(const LocatedScan& scan, const char* kind, double radius) {
  return std::string("<circle class=\"") + kind + "\" cx=\"" + Number(scan.T_world_robot.mean.x) +
         "\" cy=\"" + Number(-scan.T_world_robot.mean.y) + "\" r=\"" + Number(radius) + "\"/>\n";
}

std::string DrawingOf(const OccupancyGrid& grid, const Localization& drive, FloorId floor,
                      const std::vector<MapChange>& changes) {
  const double width_m = grid.width * grid.resolution_m;
  const double height_m = grid.height * grid.resolution_m;
  const double line = std::max(0.1, 0.002 * std::max(width_m, height_m));
  std::string svg = "<svg viewBox=\"" + Number(grid.origin_x) + " " +
                    Number(-grid.origin_y - height_m) + " " + Number(width_m) + " " +
                    Number(height_m) + "\">\n" + WallsOf(grid) + LinesOf(drive, floor, line);
  for (const MapChange& change : changes) {
    if (change.floor != floor) continue;
    svg += "<circle class=\"change\" stroke-width=\"" + Number(line) + "\" cx=\"" +
           Number(change.x) + "\" cy=\"" + Number(-change.y) + "\" r=\"" +
           Number(0.5 * change.size_m + 0.3) + "\"><title>" + Name(change.kind) +
           "</title></circle>\n";
  }
  const LocatedScan* first = nullptr;
  const LocatedScan* last = nullptr;
  for (const LocatedScan& scan : drive.scans) {
    if (!scan.placed || scan.floor != floor) continue;
    if (first == nullptr) first = &scan;
    last = &scan;
  }
  if (first != nullptr) {
    svg += MarkOf(*first, "start", 3.0 * line) + MarkOf(*last, "end", 3.0 * line);
  }
  return svg + "</svg>\n";
}

}  // namespace

std::string LocalizationPage(const BuildingMap& map, const Localization& drive,
                             const std::vector<MapChange>& changes, const std::string& words) {
  GridOptions options;
  options.resolution_m = kCell;
  const std::vector<OccupancyGrid> grids = RenderFloors(map, options);
  std::string page =
      kHead + std::string("<h1>Drive in the map</h1>\n<p>") + words +
      "</p>\n<p><i style=\"background:#0a58ca\"></i>sure <i style=\"background:"
      "#e07b00\"></i>placed in hindsight <i style=\"background:#c4008f\"></i>changed "
      "since the map was made; green: first, red: last scan on the floor</p>\n";
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto floor = static_cast<FloorId>(i);
    const auto scans =
        std::count_if(drive.scans.begin(), drive.scans.end(),
                      [&](const LocatedScan& scan) { return scan.placed && scan.floor == floor; });
    page += "<h2>Floor " + map.graph.floor(floor).label + "</h2>\n<p>" + std::to_string(scans) +
            " scans</p>\n";
    if (grids[i].width > 0) page += DrawingOf(grids[i], drive, floor, changes);
  }
  return page + "</body></html>\n";
}

}  // namespace masked_mapper
