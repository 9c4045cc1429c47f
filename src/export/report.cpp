// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

#include "export/viewer_page.hpp"
#include "output_file.hpp"
#include "report_columns.hpp"
#include "report_floors.hpp"
#include "report_motion.hpp"
#include "report_space.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

Json NodesJson(const std::vector<Node>& nodes, const Pose2& T_world_odom) {
  PoseColumns poses;
  std::vector<double> stamps;
  std::vector<std::uint16_t> floors;
  std::vector<std::uint8_t> has_scan;
  for (const Node& node : nodes) {
    stamps.push_back(node.stamp);
    floors.push_back(static_cast<std::uint16_t>(node.floor));
    has_scan.push_back(node.HasScan() ? 1 : 0);
    poses.Add(T_world_odom * node.T_odom_robot, node.T_world_robot);
  }
  Json json = {{"count", nodes.size()},
               {"stamp_f64", Base64(stamps)},
               {"floor_u16", Base64(floors)},
               {"has_scan_u8", Base64(has_scan)}};
  poses.WriteTo(json);
  return json;
}

Json EdgesJson(const std::vector<Edge>& edges) {
  std::vector<std::int32_t> from;
  std::vector<std::int32_t> to;
  std::vector<std::uint8_t> kinds;
  for (const Edge& edge : edges) {
    if (edge.kind == EdgeKind::kHeading) continue;
    from.push_back(edge.from);
    to.push_back(edge.to);
    kinds.push_back(static_cast<std::uint8_t>(edge.kind));
  }
  return {{"count", from.size()},
          {"kinds", NamesOf(EdgeKind{})},
          {"from_i32", Base64(from)},
          {"to_i32", Base64(to)},
          {"kind_u8", Base64(kinds)}};
}

Json ClosuresJson(const std::vector<Closure>& closures, const PoseGraph& graph) {
  std::vector<std::int32_t> newer;
  std::vector<std::int32_t> older;
  std::vector<std::int32_t> votes;
  std::vector<std::uint8_t> states;
  std::vector<std::uint32_t> reasons;
  std::map<ClosureReason, std::uint32_t> number_of_reason;
  Json reason_names = Json::array();
  // The match, and how far from it the finished map puts the two nodes.
  std::vector<float> match;
  std::vector<float> quality;
  for (const Closure& closure : closures) {
    newer.push_back(closure.newer);
    older.push_back(closure.older);
    votes.push_back(closure.votes);
    states.push_back(static_cast<std::uint8_t>(closure.state));
    const auto [reason, is_new] = number_of_reason.emplace(
        closure.reason, static_cast<std::uint32_t>(number_of_reason.size()));
    if (is_new) reason_names.push_back(Name(closure.reason));
    reasons.push_back(reason->second);
    const Pose2 T_newer_older = Inverse(closure.T_older_newer.mean);
    match.insert(match.end(),
                 {static_cast<float>(T_newer_older.x), static_cast<float>(T_newer_older.y),
                  static_cast<float>(T_newer_older.theta)});
    const Pose2 T_of_map =
        Between(graph.node(closure.newer).T_world_robot, graph.node(closure.older).T_world_robot);
    const Pose2 left = Between(T_newer_older, T_of_map);
    quality.insert(quality.end(),
                   {static_cast<float>(closure.score), static_cast<float>(closure.mahalanobis),
                    static_cast<float>(closure.agreement),
                    std::hypot(static_cast<float>(left.x), static_cast<float>(left.y)),
                    static_cast<float>(std::abs(left.theta))});
  }
  Json state_names = Json::array();
  for (const ClosureState state : {ClosureState::kRejectedScore, ClosureState::kHypothesis,
                                   ClosureState::kValidated, ClosureState::kAuditedOut}) {
    state_names.push_back(Name(state));
  }
  return {{"count", closures.size()},   {"states", state_names},
          {"reasons", reason_names},    {"a_i32", Base64(newer)},
          {"b_i32", Base64(older)},     {"votes_i32", Base64(votes)},
          {"state_u8", Base64(states)}, {"reason_u32", Base64(reasons)},
          {"match_f32", Base64(match)}, {"quality_f32", Base64(quality)}};
}

Json RouteJson(const Route& route) {
  Json legs = Json::array();
  for (const RouteLeg& leg : route.legs) {
    Json points = Json::array();
    for (const Eigen::Vector2d& point : leg.points_in_world) {
      points.push_back({point.x(), point.y()});
    }
    legs.push_back({{"floor", leg.floor}, {"points", std::move(points)}});
  }
  return {{"length_m", route.length_m}, {"legs", std::move(legs)}};
}

// Inside a <script> element only `<` can end it or open a comment; in JSON it may be written so.
std::string SafeInScript(const std::string& json) {
  std::string safe;
  safe.reserve(json.size() + 64);
  for (const char character : json) {
    if (character == '<') {
      safe += "\\u003c";
    } else {
      safe += character;
    }
  }
  return safe;
}

}  // namespace

std::string ReportData(const BuildingMap& result, const std::vector<OccupancyGrid>& grids,
                       double max_range_m, const Route* route) {
  assert(grids.size() == result.graph.floors().size());
  const Pose2 T_world_odom = WorldFromOdometry(result);
  const std::vector<Node>& nodes = result.graph.nodes();
  Json json = {{"version", 1},
               {"floors", FloorsJson(result.graph, grids)},
               {"scans", ScansJson(result, T_world_odom, max_range_m)},
               {"trajectory", TrajectoryJson(result, T_world_odom)},
               {"nodes", NodesJson(nodes, T_world_odom)},
               {"edges", EdgesJson(result.graph.edges())},
               {"attempts", ClosuresJson(result.closures, result.graph)}};
  if (!result.kept_clouds.empty()) json["space"] = SpaceJson(result);
  if (route != nullptr) json["route"] = RouteJson(*route);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ReportPage(const std::string& data, const Summary& summary) {
  const std::string_view page = ViewerPage();
  const std::size_t mark = page.find(kReportDataMark);
  assert(mark != std::string_view::npos);
  std::string text(page.substr(0, mark));
  text += "{\"map\":" + SafeInScript(data) +
          ",\n\"summary\":" + SafeInScript(SummaryText(summary)) + "}";
  text += page.substr(mark + kReportDataMark.size());
  return text;
}

void WriteReport(const std::string& data, const Summary& summary,
                 const std::filesystem::path& path) {
  WriteFile(path, ReportPage(data, summary));
}

}  // namespace masked_mapper
