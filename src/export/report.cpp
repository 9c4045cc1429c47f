// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "export/viewer_page.hpp"
#include "masked_mapper/geometry/angle.hpp"
#include "output_file.hpp"
#include "point_cloud_file.hpp"

namespace masked_mapper {
namespace {

using Json = nlohmann::ordered_json;

// Together these stay below 12 MB of page; a laptop draws them without effort.
constexpr std::size_t kMaxWallPoints = 1000000;
constexpr std::size_t kMaxScanPoints = 500000;
constexpr std::size_t kMaxFreeCells = 8000000;
constexpr std::size_t kMaxTrajectoryPoses = 30000;
// What every WebGL 2 can hold in one direction of a texture.
constexpr int kMaxTextureSide = 2048;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

std::string Base64(const void* data, std::size_t size) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::uint32_t left = static_cast<std::uint32_t>(std::min<std::size_t>(3, size - i));
    std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (left > 1) group |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (left > 2) group |= bytes[i + 2];
    text += kDigits[group >> 18 & 63U];
    text += kDigits[group >> 12 & 63U];
    text += left > 1 ? kDigits[group >> 6 & 63U] : '=';
    text += left > 2 ? kDigits[group & 63U] : '=';
  }
  return text;
}

template <typename T>
std::string Base64(const std::vector<T>& column) {
  return Base64(column.data(), column.size() * sizeof(T));
}

// Not `int` halves: a floor is some hundred metres, and 16 bits make that millimetres.
std::uint16_t Quantised(double value, double step) {
  return static_cast<std::uint16_t>(std::clamp(std::round(value / step), 0.0, 65535.0));
}

std::int16_t QuantisedSigned(double value, double step) {
  return static_cast<std::int16_t>(std::clamp(std::round(value / step), -32767.0, 32767.0));
}

// Every `factor` x `factor` block of cells that holds a wall gives its first wall point.
std::vector<WallPoint> ThinnedWalls(const OccupancyGrid& grid, int factor) {
  if (factor == 1) return grid.walls;
  const int columns = (grid.width + factor - 1) / factor;
  std::vector<WallPoint> thinned;
  std::vector<bool> taken;
  std::size_t wall = 0;
  for (int row = 0; row < grid.height; ++row) {
    if (row % factor == 0) taken.assign(static_cast<std::size_t>(columns), false);
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kOccupied) continue;
      const WallPoint& point = grid.walls[wall++];
      const auto block = static_cast<std::size_t>(column / factor);
      if (!taken[block]) thinned.push_back(point);
      taken[block] = true;
    }
  }
  return thinned;
}

// The walls of all floors, thinned alike and no more than they must be.
std::vector<std::vector<WallPoint>> WallsWithinLimit(const std::vector<OccupancyGrid>& grids,
                                                     int* factor) {
  for (*factor = 1;; ++*factor) {
    std::vector<std::vector<WallPoint>> walls;
    std::size_t count = 0;
    for (const OccupancyGrid& grid : grids) {
      walls.push_back(ThinnedWalls(grid, *factor));
      count += walls.back().size();
    }
    if (count <= kMaxWallPoints) return walls;
  }
}

Json WallsJson(const OccupancyGrid& grid, const std::vector<WallPoint>& walls, int factor) {
  const double extent = grid.resolution_m * std::max(grid.width, grid.height);
  const double step = std::max(extent / 65535.0, 0.001);
  std::vector<std::uint16_t> xy;
  xy.reserve(2 * walls.size());
  for (const WallPoint& wall : walls) {
    xy.push_back(Quantised(static_cast<double>(wall.x) - grid.origin_x, step));
    xy.push_back(Quantised(static_cast<double>(wall.y) - grid.origin_y, step));
  }
  return {{"count", walls.size()},
          {"origin", {grid.origin_x, grid.origin_y}},
          {"step_m", step},
          {"spacing_m", grid.resolution_m * factor},
          {"xy_u16", Base64(xy)}};
}

// One bit per block of cells, the lowest bit of a byte first; rows start at a byte.
Json FreeSpaceJson(const OccupancyGrid& grid, std::size_t limit) {
  int factor = 1;
  const auto side = [&factor](int cells) { return (cells + factor - 1) / factor; };
  while (static_cast<std::size_t>(side(grid.width)) * static_cast<std::size_t>(side(grid.height)) >
             limit ||
         std::max(side(grid.width), side(grid.height)) > kMaxTextureSide) {
    ++factor;
  }
  const auto bytes_per_row = static_cast<std::size_t>((side(grid.width) + 7) / 8);
  std::vector<std::uint8_t> bits(bytes_per_row * static_cast<std::size_t>(side(grid.height)));
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::kFree) continue;
      const int block = column / factor;
      std::uint8_t& byte = bits[static_cast<std::size_t>(row / factor) * bytes_per_row +
                                static_cast<std::size_t>(block / 8)];
      byte = static_cast<std::uint8_t>(byte | 1U << static_cast<unsigned>(block % 8));
    }
  }
  return {{"width", side(grid.width)},
          {"height", side(grid.height)},
          {"origin", {grid.origin_x, grid.origin_y}},
          {"cell_m", grid.resolution_m * factor},
          {"bits", Base64(bits)}};
}

Json FloorsJson(const PoseGraph& graph, const std::vector<OccupancyGrid>& grids) {
  const std::vector<Colour> colours = FloorColours(graph.floors());
  int factor = 1;
  const std::vector<std::vector<WallPoint>> walls = WallsWithinLimit(grids, &factor);
  Json json = Json::array();
  for (std::size_t i = 0; i < grids.size(); ++i) {
    char colour[8];
    std::snprintf(colour, sizeof(colour), "#%02x%02x%02x", colours[i].red, colours[i].green,
                  colours[i].blue);
    json.push_back({{"label", graph.floors()[i].label},
                    {"elevation_m", graph.floors()[i].elevation},
                    {"colour", colour},
                    {"walls", WallsJson(grids[i], walls[i], factor)},
                    {"free", FreeSpaceJson(grids[i], kMaxFreeCells / grids.size())}});
  }
  return json;
}

// Poses as columns, before and after optimisation.
struct PoseColumns {
  std::vector<float> before;  // x, y, theta of each
  std::vector<float> after;

  void Add(const Pose2& T_world_robot_before, const Pose2& T_world_robot) {
    for (const auto& [column, pose] :
         {std::pair{&before, T_world_robot_before}, std::pair{&after, T_world_robot}}) {
      column->insert(column->end(), {static_cast<float>(pose.x), static_cast<float>(pose.y),
                                     static_cast<float>(pose.theta)});
    }
  }
  void WriteTo(Json& json) const {
    json["before_f32"] = Base64(before);
    json["after_f32"] = Base64(after);
  }
};

// The motion path may start anywhere; as drawn it starts where the map does.
Pose2 WorldFromOdometry(const BuildingMap& result) {
  if (!result.graph.nodes().empty()) {
    const Node& first = result.graph.nodes().front();
    return first.T_world_robot * Inverse(first.T_odom_robot);
  }
  if (result.trajectory.empty()) return {};
  const TrajectoryPose& first = result.trajectory.front();
  return first.T_world_robot * Inverse(first.T_odom_robot);
}

// A few of the points that the kept scans hit, so that the map before optimisation can be drawn.
Json ScansJson(const BuildingMap& result, const Pose2& T_world_odom, double max_range_m) {
  std::size_t hits = 0;
  for (const KeptScan& kept : result.kept_scans) hits += kept.scan.size();
  const std::size_t stride = std::max<std::size_t>(1, (hits + kMaxScanPoints - 1) / kMaxScanPoints);
  const double step = std::max(max_range_m, 1.0) * 1.1 / 32767.0;  // the scanner is off centre

  PoseColumns poses;
  std::vector<std::uint16_t> floors;
  std::vector<std::uint32_t> counts;
  std::vector<std::int16_t> xy;
  std::size_t place = 0;
  for (const KeptScan& kept : result.kept_scans) {
    const TrajectoryPose& pose = result.trajectory.at(kept.trajectory_index);
    if (pose.in_transit) continue;
    std::uint32_t count = 0;
    for (std::size_t beam = 0; beam < kept.scan.size(); ++beam) {
      if (place++ % stride != 0 || !kept.scan.IsHit(beam)) continue;
      const auto range = static_cast<double>(kept.scan.ranges[beam]);
      if (range > max_range_m) continue;
      const double angle = kept.scan.Angle(beam);
      const Eigen::Vector2d point_in_robot =
          kept.scan.T_robot_laser *
          Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
      xy.push_back(QuantisedSigned(point_in_robot.x(), step));
      xy.push_back(QuantisedSigned(point_in_robot.y(), step));
      ++count;
    }
    if (count == 0) continue;
    poses.Add(T_world_odom * pose.T_odom_robot, pose.T_world_robot);
    floors.push_back(static_cast<std::uint16_t>(pose.floor));
    counts.push_back(count);
  }
  Json json = {{"count", counts.size()},
               {"step_m", step},
               {"floor_u16", Base64(floors)},
               {"points_u32", Base64(counts)},
               {"xy_i16", Base64(xy)}};
  poses.WriteTo(json);
  return json;
}

// Whether a scan is the first of a drive after the first.
bool BeginsDrive(const BuildingMap& result, std::size_t pose) {
  return std::any_of(result.drives.begin(), result.drives.end(),
                     [&](const Drive& drive) { return pose > 0 && drive.first_pose == pose; });
}

// The poses to draw: where floors change or drives begin and end, and otherwise after `step` metres
// or some turning.
std::vector<std::size_t> DrawnPoses(const BuildingMap& result, double step) {
  const std::vector<TrajectoryPose>& trajectory = result.trajectory;
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TrajectoryPose& pose = trajectory[i];
    const bool is_end = BeginsDrive(result, i) || BeginsDrive(result, i + 1);
    if (!drawn.empty() && i + 1 < trajectory.size() && !is_end) {
      const TrajectoryPose& last = trajectory[drawn.back()];
      const bool same_place = pose.floor == last.floor && pose.in_transit == last.in_transit;
      if (same_place && Distance(last.T_odom_robot, pose.T_odom_robot) < step &&
          Distance(last.T_world_robot, pose.T_world_robot) < step) {
        continue;
      }
    }
    drawn.push_back(i);
  }
  return drawn;
}

Json TrajectoryJson(const BuildingMap& result, const Pose2& T_world_odom) {
  const std::vector<TrajectoryPose>& trajectory = result.trajectory;
  double step = 0.1;
  std::vector<std::size_t> drawn = DrawnPoses(result, step);
  while (drawn.size() > kMaxTrajectoryPoses && step < 10.0) {
    step *= 1.5;
    drawn = DrawnPoses(result, step);
  }
  PoseColumns poses;
  std::vector<double> stamps;
  std::vector<std::uint16_t> floors;
  std::vector<std::uint8_t> in_transit;
  std::vector<std::size_t> breaks;  // no way leads here from the one before
  for (const std::size_t i : drawn) {
    const TrajectoryPose& pose = trajectory[i];
    if (BeginsDrive(result, i)) breaks.push_back(stamps.size());
    stamps.push_back(pose.stamp);
    floors.push_back(static_cast<std::uint16_t>(pose.floor));
    in_transit.push_back(pose.in_transit ? 1 : 0);
    poses.Add(T_world_odom * pose.T_odom_robot, pose.T_world_robot);
  }
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    if (BeginsDrive(result, i)) continue;
    length += Distance(trajectory[i - 1].T_world_robot, trajectory[i].T_world_robot);
  }
  Json json = {{"count", drawn.size()},
               {"length_m", length},
               {"stamp_f64", Base64(stamps)},
               {"floor_u16", Base64(floors)},
               {"in_transit_u8", Base64(in_transit)}};
  if (!breaks.empty()) json["breaks"] = breaks;
  poses.WriteTo(json);
  return json;
}

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
    from.push_back(edge.from);
    to.push_back(edge.to);
    kinds.push_back(static_cast<std::uint8_t>(edge.kind));
  }
  return {{"count", edges.size()},
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
                       double max_range_m) {
  assert(grids.size() == result.graph.floors().size());
  const Pose2 T_world_odom = WorldFromOdometry(result);
  const std::vector<Node>& nodes = result.graph.nodes();
  const Json json = {{"version", 1},
                     {"floors", FloorsJson(result.graph, grids)},
                     {"scans", ScansJson(result, T_world_odom, max_range_m)},
                     {"trajectory", TrajectoryJson(result, T_world_odom)},
                     {"nodes", NodesJson(nodes, T_world_odom)},
                     {"edges", EdgesJson(result.graph.edges())},
                     {"attempts", ClosuresJson(result.closures, result.graph)}};
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
