// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/evaluation/result_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "masked_mapper/evaluation/number_lines.hpp"
#include "masked_mapper/log/input_error.hpp"

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

std::vector<MappedFloor> ReadFloors(const std::string& path) {
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
  std::vector<MappedFloor> floors;
  for (const auto& entry : *list) {
    if (!entry.is_object() || !entry.contains("label") || !entry["label"].is_string() ||
        !entry.contains("elevation_m") || !entry["elevation_m"].is_number()) {
      fail("an entry of `floors` lacks `label` or `elevation_m`");
    }
    floors.push_back({entry["label"].get<std::string>(), entry["elevation_m"].get<double>()});
  }
  return floors;
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
  result.trajectory = ReadTrajectory((root / "trajectory.tum").string());
  if (Exists(root / "summary.json")) result.floors = ReadFloors((root / "summary.json").string());
  if (Exists(root / "nodes.tum") && Exists(root / "graph.g2o")) {
    result.graph = ReadGraph(root);
    if (Exists(root / "closures.csv")) {
      result.closures = ReadClosures((root / "closures.csv").string(), result.graph->nodes);
    }
  }
  return result;
}

}  // namespace masked_mapper
