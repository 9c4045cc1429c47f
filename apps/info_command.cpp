// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper info LOG|OUT|MAP [--json]
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.hpp"
#include "map_info.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/log/log_summary.hpp"
#include "masked_mapper/mapping/log_survey.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "option_flags.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string log;
  OptionFlags options;
  bool json = false;
  bool quiet = false;
};

/// "361 (1988 scans)", several in order of their number; of a scanner that never gives the same
/// number twice, "240 to 460, mostly 457 (86 of 263 scans)".
std::string BeamsText(const LogSummary& summary) {
  const auto& counts = summary.scans_of_beams;
  constexpr std::size_t kMostListed = 4;
  if (counts.empty()) return "none";
  if (counts.size() > kMostListed) {
    const auto most =
        std::max_element(counts.begin(), counts.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return std::to_string(counts.begin()->first) + " to " + std::to_string(counts.rbegin()->first) +
           ", mostly " + std::to_string(most->first) + " (" + std::to_string(most->second) +
           " of " + std::to_string(summary.statistics.scans) + " scans)";
  }
  std::string text;
  for (const auto& [beams, scans] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(beams) + " (" + std::to_string(scans) +
            " scans)";
  }
  return text;
}

/// What a person should know before trusting a map of this log.
std::vector<std::string> Warnings(const LogSummary& summary) {
  const LogStatistics& statistics = summary.statistics;
  std::vector<std::string> warnings;
  if (statistics.scans == 0) warnings.emplace_back("not one valid scan: this log cannot be mapped");
  if (statistics.truncated) warnings.emplace_back("the file is cut off in the middle");
  if (statistics.bad_lines > 0) {
    warnings.push_back(std::to_string(statistics.bad_lines) +
                       " bad lines are skipped, the first: " + statistics.first_bad_line);
  }
  if (statistics.stamp_jumps > 0) {
    warnings.push_back(std::to_string(statistics.stamp_jumps) +
                       " stamps that step backwards or wrap are mended");
  }
  if (statistics.empty_scans > 0) {
    warnings.push_back(std::to_string(statistics.empty_scans) + " scans have not a single return");
  }
  if (!summary.has_odometry && statistics.scans > 0) {
    warnings.emplace_back("no odometry: motion comes from scans alone");
  }
  for (const SensorFinding& finding : summary.findings) warnings.push_back(TextOf(finding));
  constexpr double kGap = 2.0;  // s without a scan: the robot may be anywhere
  if (summary.largest_gap_s > kGap) {
    warnings.push_back("no scan for " + FixedText(summary.largest_gap_s, 1) + " s after stamp " +
                       FixedText(summary.largest_gap_stamp, 3));
  }
  return warnings;
}

void PrintText(const std::string& log, const LogSummary& summary) {
  const LogStatistics& statistics = summary.statistics;
  const auto line = [](const std::string& name, const std::string& value) {
    std::cout << "  " << name << std::string(14 - name.size(), ' ') << value << "\n";
  };
  const auto readings = [&](const std::string& name, std::uint64_t count, double rate) {
    if (count > 0) line(name, std::to_string(count) + " at " + FixedText(rate, 1) + " Hz");
  };
  std::cout << log << "\n";
  line("duration", FixedText(summary.duration_s, 1) + " s");
  if (summary.has_odometry) {
    line("path", FixedText(summary.path_length_m, 1) + " m, turned by " +
                     FixedText(RadToDeg(summary.turned_rad), 0) + " deg in all, by odometry");
  }
  readings("scans", statistics.scans, summary.scan_rate_hz);
  readings("odometry", statistics.odometry, summary.odometry_rate_hz);
  readings("pressure", statistics.pressure, summary.pressure_rate_hz);
  readings("acceleration", statistics.acceleration, summary.acceleration_rate_hz);
  if (statistics.floor_labels > 0) line("floor labels", std::to_string(statistics.floor_labels));
  line("beams", BeamsText(summary));
  line("field of view", FixedText(RadToDeg(summary.field_of_view_rad), 1) + " deg");
  line("laser", "at x " + FixedText(summary.T_robot_laser.x, 3) + " m, y " +
                    FixedText(summary.T_robot_laser.y, 3) + " m, " +
                    FixedText(RadToDeg(summary.T_robot_laser.theta), 1) + " deg on the robot");
  const auto& quantiles = summary.range_quantiles_m;
  line("ranges", "5 % below " + FixedText(quantiles[0], 2) + " m, half below " +
                     FixedText(quantiles[2], 2) + " m, 95 % below " + FixedText(quantiles[4], 2) +
                     " m");
  line("no return", FixedText(100.0 * summary.share_no_return, 1) + " % of beams (beyond " +
                        FixedText(summary.max_range_m, 2) + " m), " +
                        FixedText(100.0 * summary.share_invalid, 1) + " % invalid");
  if (statistics.reordered > 0) {
    line("logged late",
         std::to_string(statistics.reordered) + " readings, put back in the order of their stamps");
  }
  for (const auto& [name, count] : statistics.other_messages) {
    line("not read", std::to_string(count) + " " + name);
  }
  for (const std::string& warning : Warnings(summary)) line("warning", warning);
}

void PrintJson(const std::string& log, const LogSummary& summary) {
  const LogStatistics& statistics = summary.statistics;
  Json beams = Json::object();
  for (const auto& [count, scans] : summary.scans_of_beams) beams[std::to_string(count)] = scans;
  Json quantiles = Json::object();
  for (std::size_t i = 0; i < LogSummary::kQuantiles.size(); ++i) {
    quantiles[FixedText(LogSummary::kQuantiles[i], 2)] = summary.range_quantiles_m[i];
  }
  Json findings = Json::array();
  for (const SensorFinding& finding : summary.findings) {
    findings.push_back({{"what", finding.what},
                        {"value", finding.value},
                        {"sigma", finding.sigma},
                        {"t_a", finding.t_a},
                        {"t_b", finding.t_b},
                        {"consequence", finding.consequence}});
  }
  const Json json = {{"log", log},
                     {"duration_s", summary.duration_s},
                     {"first_stamp", statistics.first_stamp},
                     {"last_stamp", statistics.last_stamp},
                     {"has_odometry", summary.has_odometry},
                     {"path_length_m", summary.path_length_m},
                     {"turned_deg", RadToDeg(summary.turned_rad)},
                     {"counts",
                      {{"lines", statistics.lines},
                       {"scans", statistics.scans},
                       {"odometry", statistics.odometry},
                       {"pressure", statistics.pressure},
                       {"acceleration", statistics.acceleration},
                       {"floor_labels", statistics.floor_labels},
                       {"bad_lines", statistics.bad_lines},
                       {"empty_scans", statistics.empty_scans},
                       {"stamps_mended", statistics.stamp_jumps},
                       {"logged_late", statistics.reordered}}},
                     {"rates_hz",
                      {{"scans", summary.scan_rate_hz},
                       {"odometry", summary.odometry_rate_hz},
                       {"pressure", summary.pressure_rate_hz},
                       {"acceleration", summary.acceleration_rate_hz}}},
                     {"other_messages", statistics.other_messages},
                     {"scans_of_beams", beams},
                     {"field_of_view_deg", RadToDeg(summary.field_of_view_rad)},
                     {"T_robot_laser",
                      {{"x_m", summary.T_robot_laser.x},
                       {"y_m", summary.T_robot_laser.y},
                       {"theta_deg", RadToDeg(summary.T_robot_laser.theta)}}},
                     {"max_range_m", summary.max_range_m},
                     {"range_quantiles_m", quantiles},
                     {"share_no_return", summary.share_no_return},
                     {"share_invalid", summary.share_invalid},
                     {"largest_gap_s", summary.largest_gap_s},
                     {"largest_gap_stamp", summary.largest_gap_stamp},
                     {"truncated", statistics.truncated},
                     {"first_bad_line", statistics.first_bad_line},
                     {"warnings", Warnings(summary)},
                     {"sensors", {{"findings", findings}}}};
  // A path or a bad line may hold bytes that are no UTF-8.
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

int RunInfo(const InfoArguments& arguments) {
  const Options options = ReadOptions(arguments.options);
  if (IsOutOrMap(arguments.log)) {
    PrintMapInfo(arguments.log, arguments.json);
    return 0;
  }
  LogSource source(arguments.log, options.mapping.log);
  LogSummary summary = Summarise(source);
  // What a map would find out of the sensors before it is begun.
  if (summary.statistics.scans > 0) summary.findings = SurveyLog(source, options.mapping).findings;
  (arguments.json ? PrintJson : PrintText)(arguments.log, summary);
  return 0;
}

}  // namespace

void AddInfoCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command =
      program.add_subcommand("info", "Say what is in a log or in a map, and whether it is sound");
  command
      ->add_option("LOG", arguments->log,
                   "the robot's log, or a folder that `map` wrote, or its building.mmap")
      ->required()
      ->type_name("LOG|OUT|MAP");
  command->add_flag("--json", arguments->json, "as JSON, for programs");
  AddOptionFlags(*command, arguments->options);
  command->add_flag("--quiet", arguments->quiet, "print errors and the result only");
  command->footer(
      "Examples:\n"
      "  masked_mapper info drive.log.gz\n"
      "  masked_mapper info drive.log.gz --json | jq .warnings\n"
      "  masked_mapper info out");
  command->callback([arguments, &run] { run = [arguments] { return RunInfo(*arguments); }; });
}

}  // namespace masked_mapper
