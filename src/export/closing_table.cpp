// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/summary_file.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kNameWidth = 14;
constexpr std::size_t kNumberWidth = 9;

std::string Right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string Left(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string Line(const std::string& name, const std::string& number, const std::string& rest) {
  return "  " + Left(name, kNameWidth) + Right(number, kNumberWidth) +
         (rest.empty() ? "" : "  " + rest) + "\n";
}

std::string Line(const std::string& name, std::uint64_t count, const std::string& rest = "") {
  return Line(name, std::to_string(count), rest);
}

std::string CountLines(const Summary& summary) {
  const Summary::Counts& counts = summary.counts;
  std::string text =
      Line("scans", counts.scans, "of " + std::to_string(counts.observations) + " observations") +
      Line("nodes", counts.nodes,
           std::to_string(counts.scan_nodes) + " with a scan, " +
               std::to_string(counts.odometry_nodes) + " of odometry alone") +
      Line("attempted", counts.attempted, "pairs offered to the matcher") +
      Line("matched", counts.matched) + Line("validated", counts.validated);
  for (const auto& [reason, count] : summary.rejections) {
    text += Line("  not used", count, reason);
  }
  return text;
}

std::string FloorLines(const std::vector<Summary::FloorEntry>& floors) {
  std::string text;
  for (const Summary::FloorEntry& floor : floors) {
    text += Line("floor " + floor.label, FixedText(floor.area_m2, 0),
                 "m2, at " + FixedText(floor.elevation_m, 2) + " m" +
                     (floor.elevation_measured || floors.size() == 1 ? "" : " (assumed)") + ", " +
                     std::to_string(floor.nodes) + " nodes");
  }
  return text;
}

std::string DriveLines(const std::vector<DriveFacts>& drives) {
  std::string text;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const DriveFacts& drive = drives[i];
    std::string rest = "closures to other drives";
    if (!drive.joined) rest += ", NOT JOINED: a piece of its own";
    if (!drive.reason.empty()) rest += (drive.joined ? ", " : ": ") + drive.reason;
    text += Line("drive " + std::to_string(i + 1), drive.closures_to_others,
                 rest + " (" + drive.log + ")");
  }
  return text;
}

std::string DoubtLines(const Summary& summary) {
  std::string text;
  for (const Doubt& doubt : summary.doubts) {
    const std::string& floor = summary.floors.at(static_cast<std::size_t>(doubt.floor)).label;
    text += Line("DOUBT", std::string(Name(doubt.kind)),
                 doubt.text + " (floor " + floor + ", " + FixedText(doubt.x, 1) + ", " +
                     FixedText(doubt.y, 1) + ")" +
                     (doubt.edit.empty() ? "" : "; edits.yaml: " + doubt.edit));
  }
  return text;
}

std::string SecondsLines(const Summary& summary) {
  const StageSeconds& seconds = summary.seconds;
  const std::vector<std::pair<std::string, double>> stages = {
      {"read", seconds.read},
      {"motion", seconds.motion},
      {"mask", seconds.mask},
      {"projection", seconds.projection},
      {"matching", seconds.matching},
      {"validation", seconds.validation},
      {"optimisation", seconds.optimisation},
      {"rendering", seconds.rendering},
      {"export", seconds.export_},
      {"total", seconds.total}};
  std::string text;
  for (const auto& [stage, value] : stages) text += Line(stage, FixedText(value, 3), "s");
  return text + Line("peak memory", FixedText(summary.peak_memory_mib, 0), "MiB");
}

}  // namespace

std::string ClosingTable(const Summary& summary) {
  return CountLines(summary) + FloorLines(summary.floors) + DriveLines(summary.drives) +
         DoubtLines(summary) + SecondsLines(summary);
}

}  // namespace masked_mapper
