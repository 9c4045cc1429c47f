// SPDX-License-Identifier: BSD-3-Clause
#include "result_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "masked_mapper/text/input_error.hpp"
#include "number_lines.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kClosuresHeading =
    "t_a,t_b,floor,dx,dy,dtheta,score,maha,votes,state,reason";

std::size_t NodeNumber(std::string_view word, std::size_t nodes, const FileLine& line) {
  const double value = NumberIn(word, line);
  if (value < 0.0 || value != std::floor(value) || value >= static_cast<double>(nodes)) {
    line.Fail("`" + std::string(word.substr(0, 40)) + "` is no node of nodes.tum");
  }
  return static_cast<std::size_t>(value);
}

std::vector<GraphEdge> ReadEdges(const std::string& path, std::size_t nodes) {
  constexpr std::size_t kEdgeWords = 12;  // tag, two ends, three of the pose, six of information
  std::vector<GraphEdge> edges;
  std::size_t vertices = 0;
  ForEachLine(path, [&](std::string_view text, const FileLine& line) {
    const std::vector<std::string_view> words = WordsOf(text);
    if (words.empty() || words.front().front() == '#') return;
    if (words.front() == "VERTEX_SE2") {
      if (words.size() != 5) line.Fail("expected `VERTEX_SE2 id x y theta`");
      NodeNumber(words[1], nodes, line);
      ++vertices;
    } else if (words.front() == "EDGE_SE2") {
      if (words.size() != kEdgeWords) line.Fail("an EDGE_SE2 has 11 numbers");
      edges.push_back({NodeNumber(words[1], nodes, line), NodeNumber(words[2], nodes, line)});
    }
  });
  if (vertices != nodes) {
    throw InputError(path + ": has " + std::to_string(vertices) + " vertices, nodes.tum has " +
                     std::to_string(nodes) + " nodes");
  }
  return edges;
}

MappedGraph ReadGraph(const fs::path& folder) {
  MappedGraph graph;
  const std::string nodes_path = (folder / "nodes.tum").string();
  graph.nodes = ReadTrajectoryInFileOrder(nodes_path);
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; };
  if (!std::is_sorted(graph.nodes.begin(), graph.nodes.end(), earlier)) {
    throw InputError(nodes_path + ": the stamps of the nodes step back");
  }
  graph.edges = ReadEdges((folder / "graph.g2o").string(), graph.nodes.size());
  return graph;
}

/// Fields of one line, those in quotes without them (RFC 4180).
std::vector<std::string> FieldsOf(std::string_view text, const FileLine& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char character = text[i];
    if (quoted && character == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (character == '"') {
      quoted = !quoted;
    } else if (character == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += character;
    }
  }
  if (quoted) line.Fail("a quote is not closed");
  return fields;
}

// Where nodes share a stamp, those of a floor change come first and the one with the scan last.
std::size_t NodeAt(const std::vector<StampedPose>& nodes, double stamp, const FileLine& line) {
  const auto behind =
      std::upper_bound(nodes.begin(), nodes.end(), stamp,
                       [](double value, const StampedPose& node) { return value < node.stamp; });
  if (behind == nodes.begin() || std::prev(behind)->stamp != stamp) {
    line.Fail("no node of nodes.tum has the stamp of this attempt");
  }
  return static_cast<std::size_t>(behind - nodes.begin()) - 1;
}

std::vector<ValidatedClosure> ReadClosures(const std::string& path,
                                           const std::vector<StampedPose>& nodes) {
  constexpr std::size_t kState = 9;
  static const std::vector<std::string> kStates = {"rejected_score", "hypothesis", "validated",
                                                   "audited_out"};
  std::vector<ValidatedClosure> closures;
  bool headed = false;
  ForEachLine(path, [&](std::string_view text, const FileLine& line) {
    if (!std::exchange(headed, true)) {
      if (text != kClosuresHeading) {
        line.Fail("expected the heading `" + std::string(kClosuresHeading) + "`");
      }
      return;
    }
    if (text.empty()) return;
    const std::vector<std::string> fields = FieldsOf(text, line);
    if (fields.size() != kState + 2) {
      line.Fail("expected 11 fields, found " + std::to_string(fields.size()));
    }
    if (std::find(kStates.begin(), kStates.end(), fields[kState]) == kStates.end()) {
      line.Fail("unknown state `" + fields[kState].substr(0, 40) + "`");
    }
    if (fields[kState] != "validated") return;
    ValidatedClosure closure;
    closure.a = NodeAt(nodes, NumberIn(fields[0], line), line);
    closure.b = NodeAt(nodes, NumberIn(fields[1], line), line);
    closure.T_a_b = {NumberIn(fields[3], line), NumberIn(fields[4], line),
                     NumberIn(fields[5], line)};
    closures.push_back(closure);
  });
  if (!headed) throw InputError(path + ": has no heading");
  return closures;
}

/// Stamps that the log does not give: place of the scan and stamp.
using MendedStamps = std::vector<std::pair<std::size_t, double>>;

MendedStamps TakeMendedStamps(const nlohmann::json& list) {
  MendedStamps mended;
  for (const auto& entry : list) {
    if (!entry.is_array() || entry.size() != 2 || !entry[0].is_number_unsigned() ||
        !entry[1].is_number()) {
      return {};
    }
    mended.emplace_back(entry[0].get<std::size_t>(), entry[1].get<double>());
  }
  return mended;
}

std::vector<MappedScan> ScansOf(const std::vector<StampedPose>& poses,
                                const std::vector<MappedDrive>& drives,
                                const MendedStamps& mended) {
  std::vector<MappedScan> scans;
  scans.reserve(poses.size());
  std::size_t drive = 0;
  std::size_t in_drive = 0;
  for (const StampedPose& pose : poses) {
    while (drive + 1 < drives.size() && in_drive >= drives[drive].scans) {
      ++drive;
      in_drive = 0;
    }
    ++in_drive;
    scans.push_back({pose, pose.stamp + (drives.empty() ? 0.0 : drives[drive].stamp_offset)});
  }
  for (const auto& [scan, stamp] : mended) {
    if (scan < scans.size()) scans[scan].stamp = stamp;
  }
  return scans;
}

std::vector<StampedPose> InOrderOfStamps(const std::vector<MappedScan>& scans) {
  std::vector<StampedPose> poses;
  poses.reserve(scans.size());
  for (const MappedScan& scan : scans) poses.push_back(scan.pose);
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  return poses;
}

/// The log's stamps of the scans at which nodes were made; a node's own where there is no such
/// scan.
std::vector<double> LogStampsOf(const std::vector<StampedPose>& nodes,
                                const std::vector<MappedScan>& scans) {
  constexpr double kSameStamp = 1e-5;  // s
  std::vector<double> stamps;
  stamps.reserve(nodes.size());
  auto scan = scans.begin();
  for (const StampedPose& node : nodes) {
    scan = std::find_if(scan, scans.end(), [&node](const MappedScan& candidate) {
      return candidate.stamp >= node.stamp - kSameStamp;
    });
    const bool is_there = scan != scans.end() && scan->stamp <= node.stamp + kSameStamp;
    stamps.push_back(is_there ? scan->pose.stamp : node.stamp);
  }
  return stamps;
}

// Floors, drives and mended stamps of summary.json.
void ReadSummary(const std::string& path, ResultFolder& result, MendedStamps& mended) {
  std::string text;
  ForEachLine(path, [&text](std::string_view line, const FileLine&) {
    text.append(line);
    text += '\n';
  });
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto fail = [&path](const std::string& reason) { throw InputError(path + ": " + reason); };
  if (json.is_discarded() || !json.is_object()) fail("is no JSON object");
  const auto list = json.find("floors");
  if (list == json.end() || !list->is_array()) fail("has no list `floors`");
  for (const auto& entry : *list) {
    if (!entry.is_object() || !entry.contains("label") || !entry["label"].is_string() ||
        !entry.contains("elevation_m") || !entry["elevation_m"].is_number()) {
      fail("an entry of `floors` lacks `label` or `elevation_m`");
    }
    result.floors.push_back(
        {entry["label"].get<std::string>(), entry["elevation_m"].get<double>()});
  }
  if (json.contains("mended_stamps")) mended = TakeMendedStamps(json["mended_stamps"]);
  const auto drives = json.find("drives");
  if (drives == json.end()) return;
  if (!drives->is_array()) fail("`drives` is no list");
  for (const auto& entry : *drives) {
    const auto is_count = [&](const char* key) {
      return entry.is_object() && entry.contains(key) && entry[key].is_number_unsigned();
    };
    if (!is_count("scans") || !is_count("nodes") || !entry.contains("stamp_offset_s") ||
        !entry["stamp_offset_s"].is_number() || !entry.contains("floors") ||
        !entry["floors"].is_array()) {
      fail("an entry of `drives` lacks `scans`, `nodes`, `stamp_offset_s` or `floors`");
    }
    MappedDrive drive{entry["scans"].get<std::size_t>(),
                      entry["nodes"].get<std::size_t>(),
                      entry["stamp_offset_s"].get<double>(),
                      {}};
    for (const auto& label : entry["floors"]) {
      if (!label.is_string()) fail("a floor of `drives` is no label");
      drive.floors.push_back(label.get<std::string>());
    }
    result.drives.push_back(std::move(drive));
  }
}

template <typename T>
std::vector<T> PartOf(const std::vector<T>& all, std::size_t first, std::size_t count) {
  first = std::min(first, all.size());
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(std::min(count, all.size() - first))};
}

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

}  // namespace

std::size_t NearestFloor(const std::vector<MappedFloor>& floors, double z) {
  const auto nearest = std::min_element(
      floors.begin(), floors.end(), [z](const MappedFloor& a, const MappedFloor& b) {
        return std::abs(a.elevation - z) < std::abs(b.elevation - z);
      });
  return static_cast<std::size_t>(nearest - floors.begin());
}

ResultFolder ReadResultFolder(const std::string& folder) {
  const fs::path root(folder);
  std::error_code error;
  if (!fs::is_directory(root, error)) {
    throw InputError(folder + ": is no folder written by `map`");
  }
  ResultFolder result;
  if (!Exists(root / "trajectory.tum")) {
    throw InputError(folder + ": holds no trajectory.tum, so `map` did not finish it");
  }
  MendedStamps mended;
  if (Exists(root / "summary.json")) ReadSummary((root / "summary.json").string(), result, mended);
  result.scans =
      ScansOf(ReadTrajectoryInFileOrder((root / "trajectory.tum").string()), result.drives, mended);
  result.trajectory = InOrderOfStamps(result.scans);
  if (Exists(root / "nodes.tum") && Exists(root / "graph.g2o")) {
    result.graph = ReadGraph(root);
    result.graph->log_stamps = LogStampsOf(result.graph->nodes, result.scans);
    if (Exists(root / "closures.csv")) {
      result.closures = ReadClosures((root / "closures.csv").string(), result.graph->nodes);
    }
  }
  return result;
}

ResultFolder OneDrive(const std::string& folder, const ResultFolder& result, std::size_t number) {
  const std::size_t drives = std::max<std::size_t>(1, result.drives.size());
  if (number < 1 || number > drives) {
    throw InputError("--drive: " + folder + " holds " + std::to_string(drives) +
                     (drives == 1 ? " drive, not " : " drives, not ") + std::to_string(number));
  }
  if (result.drives.empty()) return result;
  // Ends of what comes before, of which sums of an enemy's numbers may be anything.
  std::size_t first_scan = 0;
  std::size_t first_node = 0;
  const std::size_t all_nodes = result.graph ? result.graph->nodes.size() : 0;
  for (std::size_t i = 0; i + 1 < number; ++i) {
    const MappedDrive& before = result.drives[i];
    first_scan =
        std::min(result.scans.size(), first_scan + std::min(result.scans.size(), before.scans));
    first_node = std::min(all_nodes, first_node + std::min(all_nodes, before.nodes));
  }
  const MappedDrive& drive = result.drives[number - 1];
  ResultFolder one;
  one.scans = PartOf(result.scans, first_scan, drive.scans);
  if (one.scans.empty()) {
    throw InputError(folder + ": trajectory.tum has no scan of drive " + std::to_string(number));
  }
  for (MappedScan& scan : one.scans) scan.stamp -= drive.stamp_offset;
  one.trajectory = InOrderOfStamps(one.scans);
  for (const MappedFloor& floor : result.floors) {
    if (std::find(drive.floors.begin(), drive.floors.end(), floor.label) != drive.floors.end()) {
      one.floors.push_back(floor);
    }
  }
  if (!result.graph) return one;
  one.graph.emplace();
  one.graph->nodes = PartOf(result.graph->nodes, first_node, drive.nodes);
  one.graph->log_stamps = PartOf(result.graph->log_stamps, first_node, drive.nodes);
  for (StampedPose& node : one.graph->nodes) node.stamp -= drive.stamp_offset;
  const std::size_t nodes = one.graph->nodes.size();
  const auto is_own = [&](std::size_t node) {
    return node >= first_node && node - first_node < nodes;
  };
  for (const GraphEdge& edge : result.graph->edges) {
    if (!is_own(edge.from) || !is_own(edge.to)) continue;
    one.graph->edges.push_back({edge.from - first_node, edge.to - first_node});
  }
  if (!result.closures) return one;
  one.closures.emplace();
  for (ValidatedClosure closure : *result.closures) {
    if (!is_own(closure.a) || !is_own(closure.b)) continue;
    closure.a -= first_node;
    closure.b -= first_node;
    one.closures->push_back(closure);
  }
  return one;
}

}  // namespace masked_mapper
