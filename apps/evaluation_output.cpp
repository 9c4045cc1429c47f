// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_output.hpp"

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

Json SpreadJson(const ErrorStatistics& statistics) {
  return {{"mean", statistics.mean},
          {"std", statistics.std},
          {"median", statistics.median},
          {"max", statistics.max}};
}

void AddPosition(Json& json, const AbsoluteError& error) {
  json["mean_m"] = error.position_m.mean;
  json["std_m"] = error.position_m.std;
  json["median_m"] = error.position_m.median;
  json["p99_m"] = error.position_m.p99;
  json["max_m"] = error.position_m.max;
  json["heading_deg"] = SpreadJson(error.heading_deg);
}

Json AbsoluteJson(const AbsoluteError& error) {
  Json json;
  AddPosition(json, error);
  return json;
}

Json RelationsJson(const RelationsError& relations) {
  Json json = {{"count", relations.count}, {"used", relations.used}};
  if (relations.used > 0) {
    json["translation_m"] = SpreadJson(relations.translation_m);
    json["rotation_deg"] = SpreadJson(relations.rotation_deg);
  }
  return json;
}

Json TrajectoryJson(const TrajectoryError& error) {
  Json json = {{"scans", error.scans}, {"paired", error.paired}};
  AddPosition(json, error.as_it_stands);
  json["aligned"] = AbsoluteJson(error.aligned);
  json["elevation_m"] = SpreadJson(error.elevation_m);
  json["relative"] = {{"over_m", error.relative_over_m},
                      {"count", error.relative_translation_m.count},
                      {"translation_m", SpreadJson(error.relative_translation_m)},
                      {"rotation_deg", SpreadJson(error.relative_rotation_deg)}};
  json["floors"] = Json::array();
  for (const FloorError& floor : error.floors) {
    Json entry = {{"label", floor.label}, {"paired", floor.as_it_stands.position_m.count}};
    AddPosition(entry, floor.as_it_stands);
    entry["aligned"] = AbsoluteJson(floor.aligned);
    json["floors"].push_back(entry);
  }
  return json;
}

Json ClosuresJson(const ClosureError& closures) {
  Json json = {{"validated", closures.validated},
               {"checked", closures.checked},
               {"false", closures.false_closures.size()},
               {"true_pairs", closures.true_pairs},
               {"closed_pairs", closures.closed_pairs}};
  if (closures.Precision()) json["precision"] = *closures.Precision();
  if (closures.Recall()) json["recall"] = *closures.Recall();
  json["false_closures"] = Json::array();
  for (const FalseClosure& closure : closures.false_closures) {
    json["false_closures"].push_back({{"t_a", closure.stamp_a},
                                      {"t_b", closure.stamp_b},
                                      {"translation_m", closure.translation_m},
                                      {"rotation_deg", closure.rotation_deg}});
  }
  return json;
}

void PrintJson(const Evaluation& evaluation) {
  Json json = Json::object();
  if (evaluation.relations) json["relations"] = RelationsJson(*evaluation.relations);
  if (evaluation.trajectory) json["trajectory"] = TrajectoryJson(*evaluation.trajectory);
  if (evaluation.closures) json["closures"] = ClosuresJson(*evaluation.closures);
  if (evaluation.floors) {
    json["floors"] = {{"right", evaluation.floors->Right()},
                      {"scans", evaluation.floors->scans},
                      {"same_label", evaluation.floors->same_label},
                      {"renaming", evaluation.floors->renaming}};
  }
  if (evaluation.path_length) {
    json["path_length"] = {{"mean_m", evaluation.path_length->error_m.mean},
                           {"median_m", evaluation.path_length->error_m.median},
                           {"max_m", evaluation.path_length->error_m.max},
                           {"missing_m", evaluation.path_length->missing_m},
                           {"false_m", evaluation.path_length->false_m},
                           {"pairs", evaluation.path_length->error_m.count}};
  }
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

std::string Percent(double share) { return FixedText(100.0 * share, 2) + " %"; }

void Line(const std::string& name, const std::string& value) {
  const std::size_t width = 22;
  std::cout << "  " << name << std::string(name.size() < width ? width - name.size() : 1, ' ')
            << value << "\n";
}

std::string SpreadText(const ErrorStatistics& statistics, int decimals, const std::string& unit) {
  return FixedText(statistics.mean, decimals) + " +- " + FixedText(statistics.std, decimals) + " " +
         unit + " (median " + FixedText(statistics.median, decimals) + ", largest " +
         FixedText(statistics.max, decimals) + ")";
}

std::string PositionText(const ErrorStatistics& statistics) {
  return "mean " + FixedText(statistics.mean, 3) + " m, median " + FixedText(statistics.median, 3) +
         " m, 99 % below " + FixedText(statistics.p99, 3) + " m, largest " +
         FixedText(statistics.max, 3) + " m";
}

void PrintTrajectory(const TrajectoryError& error) {
  std::cout << "trajectory: " << error.paired << " of " << error.scans << " scans compared\n";
  Line("as it stands", PositionText(error.as_it_stands.position_m));
  Line("aligned", PositionText(error.aligned.position_m));
  Line("heading, aligned", SpreadText(error.aligned.heading_deg, 3, "deg"));
  Line("elevation", SpreadText(error.elevation_m, 3, "m"));
  const std::string stretch = "over " + FixedText(error.relative_over_m, 0) + " m of the way";
  if (error.relative_translation_m.count > 0) {
    Line(stretch, SpreadText(error.relative_translation_m, 3, "m"));
    Line("", SpreadText(error.relative_rotation_deg, 3, "deg"));
  }
  for (const FloorError& floor : error.floors) {
    Line("floor " + floor.label, "mean " + FixedText(floor.as_it_stands.position_m.mean, 3) +
                                     " m, aligned " + FixedText(floor.aligned.position_m.mean, 3) +
                                     " m (" + std::to_string(floor.aligned.position_m.count) +
                                     " scans)");
  }
}

void PrintClosures(const ClosureError& closures) {
  std::cout << "closures\n";
  Line("validated", std::to_string(closures.validated) + ", " + std::to_string(closures.checked) +
                        " checked, " + std::to_string(closures.false_closures.size()) + " false");
  if (closures.Precision()) Line("precision", Percent(*closures.Precision()));
  if (closures.Recall()) {
    Line("recall", Percent(*closures.Recall()) + " of " + std::to_string(closures.true_pairs) +
                       " pairs of nodes that see the same place");
  }
  for (const FalseClosure& closure : closures.false_closures) {
    Line("false", "stamps " + FixedText(closure.stamp_a, 6) + " and " +
                      FixedText(closure.stamp_b, 6) + ": off by " +
                      FixedText(closure.translation_m, 2) + " m, " +
                      FixedText(closure.rotation_deg, 1) + " deg");
  }
}

void PrintText(const Evaluation& evaluation) {
  if (evaluation.relations) {
    const RelationsError& relations = *evaluation.relations;
    std::cout << "relations: " << relations.used << " of " << relations.count << " used\n";
    if (relations.used > 0) {
      Line("translation", SpreadText(relations.translation_m, 4, "m"));
      Line("rotation", SpreadText(relations.rotation_deg, 3, "deg"));
    }
  }
  if (evaluation.trajectory) PrintTrajectory(*evaluation.trajectory);
  if (evaluation.closures) PrintClosures(*evaluation.closures);
  if (evaluation.floors) {
    std::cout << "floors\n";
    Line("right", Percent(evaluation.floors->Right()) + " of " +
                      std::to_string(evaluation.floors->scans) + " scans outside transit");
  }
  if (evaluation.path_length) {
    std::cout << "path length: " << evaluation.path_length->error_m.count << " pairs of stamps\n";
    Line("error", "mean " + FixedText(evaluation.path_length->error_m.mean, 3) + " m");
    Line("missing closures", FixedText(evaluation.path_length->missing_m, 3) + " m too long");
    Line("false closures", FixedText(evaluation.path_length->false_m, 3) + " m too short");
  }
}

}  // namespace

void PrintEvaluation(const Evaluation& evaluation, bool as_json) {
  (as_json ? PrintJson : PrintText)(evaluation);
}

}  // namespace masked_mapper
