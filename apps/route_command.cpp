// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper route OUT|MAP --from PLACE --to PLACE
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aside_folder.hpp"
#include "commands.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/routing/route.hpp"
#include "masked_mapper/text/enum_names.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "run_description.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

struct RouteArguments {
  std::string map;
  std::string from;
  std::string to;
  std::string edits;
  std::string report;
  RouteOptions options;
  bool without_stairs = false;
  bool json = false;
  bool quiet = false;
};

const std::string& LabelOf(const BuildingMap& map, FloorId floor) {
  return map.graph.floor(floor).label;
}

double Millimetres(double metres) { return std::round(metres * 1000.0) / 1000.0; }

Json PlaceJson(const BuildingMap& map, const Place& place) {
  return {{"floor", LabelOf(map, place.floor)},
          {"x", Millimetres(place.at_in_world.x())},
          {"y", Millimetres(place.at_in_world.y())}};
}

void PrintJson(const BuildingMap& map, const Route& route, const Place& asked_to) {
  Json legs = Json::array();
  for (const RouteLeg& leg : route.legs) {
    Json points = Json::array();
    for (const Eigen::Vector2d& point : leg.points_in_world) {
      points.push_back({Millimetres(point.x()), Millimetres(point.y())});
    }
    legs.push_back({{"floor", LabelOf(map, leg.floor)},
                    {"length_m", Millimetres(leg.length_m)},
                    {"points", std::move(points)}});
  }
  Json transits = Json::array();
  for (const RouteTransit& transit : route.transits) {
    transits.push_back({{"from", LabelOf(map, transit.from)},
                        {"to", LabelOf(map, transit.to)},
                        {"kind", Name(transit.kind)},
                        {"length_m", Millimetres(transit.length_m)}});
  }
  Json json = {{"found", route.is_found}};
  json["length_m"] = route.is_found ? Json(Millimetres(route.length_m)) : Json(nullptr);
  json["cost_m"] = route.is_found ? Json(Millimetres(route.cost_m)) : Json(nullptr);
  json["from"] = PlaceJson(map, route.from);
  json["to"] = PlaceJson(map, route.to);
  json["legs"] = std::move(legs);
  json["transits"] = std::move(transits);
  if (!route.is_found) {
    json["reason"] = route.reason;
    json["nearest"] = route.nearest ? PlaceJson(map, *route.nearest) : Json(nullptr);
    if (route.nearest) {
      json["nearest"]["distance_m"] =
          Millimetres((route.nearest->at_in_world - asked_to.at_in_world).norm());
    }
  }
  std::cout << json.dump(2) << "\n";
}

std::string PlaceText(const BuildingMap& map, const Place& place) {
  return LabelOf(map, place.floor) + "," + FixedText(place.at_in_world.x(), 2) + "," +
         FixedText(place.at_in_world.y(), 2);
}

void PrintTable(const BuildingMap& map, const Route& route, const Place& asked_to) {
  if (!route.is_found) {
    std::cout << "no way: " << route.reason << "\n";
    if (route.nearest) {
      std::cout << "nearest reachable place: " << PlaceText(map, *route.nearest) << ", "
                << FixedText((route.nearest->at_in_world - asked_to.at_in_world).norm(), 2)
                << " m from it in the plane\n";
    }
    return;
  }
  std::cout << FixedText(route.length_m, 2) << " m from " << PlaceText(map, route.from) << " to "
            << PlaceText(map, route.to) << "\n";
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    const RouteLeg& leg = route.legs[i];
    std::cout << "  floor " << LabelOf(map, leg.floor) << "  " << FixedText(leg.length_m, 2)
              << " m  ";
    for (const Eigen::Vector2d& point : leg.points_in_world) {
      std::cout << " " << FixedText(point.x(), 2) << "," << FixedText(point.y(), 2);
    }
    std::cout << "\n";
    if (i >= route.transits.size()) continue;
    const RouteTransit& transit = route.transits[i];
    std::cout << "  " << Name(transit.kind) << " from " << LabelOf(map, transit.from) << " to "
              << LabelOf(map, transit.to);
    if (transit.length_m > 0.0) std::cout << "  " << FixedText(transit.length_m, 2) << " m";
    std::cout << "\n";
  }
}

void WriteReport(const SavedMap& map, const std::vector<OccupancyGrid>& grids, const Route& route,
                 const std::filesystem::path& file) {
  const AsideFolder aside(file);
  const std::filesystem::path written = aside.path() / file.filename();
  WriteRouteReport(map.result, DescriptionOf(map.origin, map.result), grids,
                   map.origin.options.grid.max_usable_range_m, route, written);
  std::filesystem::rename(written, file);
}

int RunRoute(const RouteArguments& arguments) {
  const std::filesystem::path report =
      arguments.report.empty() ? std::filesystem::path() : FileToWrite(arguments.report);
  SavedMap map = ReadMapFile(MapFileOf(arguments.map));
  for (const std::string& line : map.left_aside) {
    if (!arguments.quiet) std::cerr << "warning: " << arguments.map << ": " << line << "\n";
  }
  if (!arguments.edits.empty()) {
    ApplyEdits(arguments.edits, map.origin.options.mapping.closures, map.result);
  }
  const Place from = PlaceOf(arguments.from, map.result);
  const Place to = PlaceOf(arguments.to, map.result);
  RouteOptions options = arguments.options;
  options.use_stairs = !arguments.without_stairs;
  SettleThreads(map.origin.options);
  const std::vector<OccupancyGrid> grids = RenderFloors(map.result, map.origin.options.grid);
  const Route route = FindRoute(map.result, grids, from, to, options);
  if (!report.empty() && route.is_found) WriteReport(map, grids, route, report);
  (arguments.json ? PrintJson : PrintTable)(map.result, route, to);
  return 0;
}

void AddFlags(CLI::App* command, RouteArguments* arguments) {
  constexpr const char* kPlace = "floor,x,y (m), t=STAMP, or the name of a place";
  command->add_option("OUT", arguments->map, "what `map` wrote, or the building.mmap in it")
      ->required()
      ->type_name("OUT|MAP");
  command->add_option("--from", arguments->from, kPlace)->required()->type_name("PLACE");
  command->add_option("--to", arguments->to, kPlace)->required()->type_name("PLACE");
  command
      ->add_option("--radius", arguments->options.clearance.radius_m,
                   "of the robot that is to go, m: so far it keeps from every wall")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str()
      ->type_name("METRES");
  command
      ->add_option("--driven-radius", arguments->options.clearance.driven_radius_m,
                   "of the robot that mapped, m: where it drove, one no larger passes, shut doors"
                   " or not")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str()
      ->type_name("METRES");
  command
      ->add_option("--ride-cost", arguments->options.ride_cost_m,
                   "a way longer by up to this is preferred to one more ride of an elevator, m")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->type_name("METRES");
  command->add_flag("--without-stairs", arguments->without_stairs, "by elevators only");
  command
      ->add_option("--edits", arguments->edits,
                   "mend the map as this file says first (docs/map_file.md)")
      ->type_name("FILE");
  command
      ->add_option("--report", arguments->report,
                   "where there is a way, the map's page with it drawn in; one there is replaced")
      ->type_name("FILE");
  command->add_flag("--json", arguments->json, "as JSON, for programs");
  command->add_flag("--quiet", arguments->quiet, "print errors and the result only");
}

}  // namespace

void AddRouteCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<RouteArguments>();
  CLI::App* command = program.add_subcommand(
      "route", "Find the shortest way through a map, from floor to floor where need be");
  AddFlags(command, arguments.get());
  command->footer(
      "The way leads through what the grids show as free, and takes the elevators and stairs that\n"
      "were driven. That there is none is an answer, too (exit code 0): it says why, and how near\n"
      "one gets. A label that begins with `-` needs an equals sign.\n\n"
      "Examples:\n"
      "  masked_mapper route out --from 0,1.5,2 --to 3,40,-7.5\n"
      "  masked_mapper route out --from=-1,3,4 --to t=1500000123.4 --radius 0.4\n"
      "  masked_mapper route out --from dock --to printer --json\n"
      "  masked_mapper route out --from 0,1.5,2 --to 3,40,-7.5 --report way.html");
  command->callback([arguments, &run] { run = [arguments] { return RunRoute(*arguments); }; });
}

}  // namespace masked_mapper
