// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/saved_map.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "annotation_rows.hpp"
#include "database.hpp"
#include "map_rows.hpp"
#include "masked_mapper/map/drives.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"
#include "masked_mapper/text/enum_names.hpp"
#include "packed_bytes.hpp"
#include "schema.hpp"

namespace masked_mapper {
namespace {

std::int64_t Id(std::size_t index) { return static_cast<std::int64_t>(index); }

void BindPose(const Pose2& pose, Statement& statement) {
  statement.Bind(pose.x).Bind(pose.y).Bind(pose.theta);
}

// As bytes: a covariance that was composed is not symmetric to the last bit.
/// An id that is -1 where there is none.
void BindId(std::int32_t id, Statement& insert) {
  if (id < 0) {
    insert.BindNull();
  } else {
    insert.Bind(std::int64_t{id});
  }
}

void BindCovariance(const Eigen::Matrix3d& covariance, Statement& statement) {
  std::string bytes;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) AppendBytes(covariance(row, column), bytes);
  }
  statement.BindBlob(bytes);
}

void WriteOrigin(const MapOrigin& origin, const BuildingMap& result, const Database& database) {
  Statement run(database, "INSERT INTO run(key, value) VALUES (?,?)");
  run.BindText("log").BindText(origin.log).Put();
  run.BindText("mask").BindText(origin.mask).Put();
  for (std::size_t i = 0; i < origin.later_logs.size(); ++i) {
    const std::string number = std::to_string(i + 2);
    run.BindText("log." + number).BindText(origin.later_logs[i].log).Put();
    if (origin.later_logs[i].floors.empty()) continue;
    run.BindText("floors." + number).BindText(origin.later_logs[i].floors).Put();
  }
  if (!origin.onto.empty()) run.BindText("onto").BindText(origin.onto).Put();
  if (!origin.so_far.empty()) run.BindText("so_far").BindText(origin.so_far).Put();
  if (!origin.identity.empty()) run.BindText("identity").BindText(origin.identity).Put();
  run.BindText("motion_source").BindText(Name(result.motion_source)).Put();
  Statement insert(database, "INSERT INTO options(key, value) VALUES (?,?)");
  for (const auto& [key, value] : ChangedOptions(origin.options)) {
    insert.BindText(key).BindText(value).Put();
  }
}

void WriteLog(const BuildingMap& result, const Database& database) {
  const LogStatistics& log = result.log;
  Statement insert(database, "INSERT INTO log_statistics(key, value) VALUES (?,?)");
  for (const LogCount& count : kLogCounts) {
    insert.BindText(count.key).Bind(static_cast<std::int64_t>(log.*count.field)).Put();
  }
  for (const LogMeasure& measure : kLogMeasures) {
    insert.BindText(measure.key).Bind(log.*measure.field).Put();
  }
  insert.BindText("truncated").Bind(std::int64_t{log.truncated}).Put();
  insert.BindText("first_bad_line").BindText(log.first_bad_line).Put();
  Statement other(database, "INSERT INTO other_messages(name, count) VALUES (?,?)");
  for (const auto& [name, count] : log.other_messages) {
    other.BindText(name).Bind(static_cast<std::int64_t>(count)).Put();
  }
  Statement warning(database, "INSERT INTO warnings(text) VALUES (?)");
  for (const std::string& text : result.warnings) warning.BindText(text).Put();
  Statement finding(database, "INSERT INTO findings VALUES (?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const SensorFinding& found = result.findings[i];
    finding.Bind(Id(i)).BindText(found.what).Bind(found.value).Bind(found.sigma);
    finding.Bind(found.t_a).Bind(found.t_b).BindText(found.consequence).Put();
  }
}

void WriteNodes(const PoseGraph& graph, const Database& database) {
  Statement floor(database, "INSERT INTO floors VALUES (?,?,?,?,?,?)");
  for (std::size_t i = 0; i < graph.floors().size(); ++i) {
    const Floor& f = graph.floors()[i];
    floor.Bind(Id(i)).BindText(f.label).Bind(f.elevation).Bind(f.elevation_sigma);
    floor.Bind(std::int64_t{f.elevation_measured}).Bind(std::int64_t{f.label_given}).Put();
  }
  Statement insert(database, "INSERT INTO nodes VALUES (?,?,?,?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const Node& node = graph.nodes()[i];
    insert.Bind(Id(i)).Bind(node.stamp).Bind(std::int64_t{node.floor});
    BindPose(node.T_odom_robot, insert);
    BindPose(node.T_world_robot, insert);
    BindId(node.scan, insert);
    insert.Put();
  }
}

void WriteEdges(const PoseGraph& graph, const Database& database) {
  Statement insert(database, "INSERT INTO edges VALUES (?,?,?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < graph.edges().size(); ++i) {
    const Edge& edge = graph.edges()[i];
    insert.Bind(Id(i)).Bind(std::int64_t{edge.from}).Bind(std::int64_t{edge.to});
    insert.BindText(Name(edge.kind));
    BindPose(edge.T_from_to.mean, insert);
    BindCovariance(edge.T_from_to.covariance, insert);
    BindId(edge.closure, insert);
    insert.Put();
  }
}

void WriteClosures(const std::vector<Closure>& closures, const Database& database) {
  Statement insert(database, "INSERT INTO closures VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const Closure& closure = closures[i];
    insert.Bind(Id(i)).Bind(std::int64_t{closure.older}).Bind(std::int64_t{closure.newer});
    BindPose(closure.T_older_newer.mean, insert);
    BindCovariance(closure.T_older_newer.covariance, insert);
    insert.Bind(closure.score).Bind(closure.mahalanobis).Bind(closure.agreement);
    insert.Bind(std::int64_t{closure.votes}).BindText(Name(closure.state));
    insert.BindText(Name(closure.reason)).Put();
  }
}

void WriteTrajectory(const std::vector<TrajectoryPose>& trajectory, const Database& database) {
  Statement insert(database, "INSERT INTO trajectory VALUES (?,?,?,?)");
  for (std::size_t begin = 0; begin < trajectory.size(); begin += kPosesPerRow) {
    const std::size_t end = std::min(begin + kPosesPerRow, trajectory.size());
    std::string bytes;
    for (std::size_t i = begin; i < end; ++i) {
      const TrajectoryPose& pose = trajectory[i];
      AppendBytes(pose.stamp, bytes);
      AppendBytes(pose.floor, bytes);
      AppendBytes(static_cast<std::uint8_t>(pose.in_transit), bytes);
      AppendBytes(pose.node_before, bytes);
      for (const Pose2& T : {pose.T_odom_robot, pose.T_world_robot}) {
        AppendBytes(T.x, bytes);
        AppendBytes(T.y, bytes);
        AppendBytes(T.theta, bytes);
      }
    }
    const std::string packed = Pack(bytes, kPoseBytes);
    insert.Bind(Id(begin / kPosesPerRow)).Bind(Id(end - begin)).BindBlob(packed);
    insert.Bind(std::int64_t{Checksum(packed)}).Put();
  }
}

// Of poses whose stamp is not their log's own, but for the shift of their drive.
void WriteLogStamps(const BuildingMap& result, const Database& database) {
  Statement insert(database, "INSERT INTO log_stamps VALUES (?,?)");
  for (std::size_t i = 0; i < result.trajectory.size(); ++i) {
    const TrajectoryPose& pose = result.trajectory[i];
    const double shift =
        result.drives.empty() ? 0.0 : result.drives[DriveOfPose(result, i)].stamp_offset_s;
    if (pose.log_stamp == pose.stamp - shift) continue;
    insert.Bind(Id(i)).Bind(pose.log_stamp).Put();
  }
}

std::string PackedRanges(const LaserScan& scan) {
  std::string bytes;
  for (const float range : scan.ranges) AppendBytes(range, bytes);
  return Pack(bytes, sizeof(float));
}

// They are packed on several threads, as many as fit into a little memory, and written in order.
void WriteScans(const std::vector<KeptScan>& kept_scans, int threads, const Database& database) {
  constexpr std::size_t kPackedAtOnce = 1024;
  constexpr std::size_t kShare = 32;
  Statement insert(database, "INSERT INTO scans VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  std::vector<std::string> all_packed(kPackedAtOnce);
  for (std::size_t i = 0; i < kept_scans.size(); ++i) {
    if (i % kPackedAtOnce == 0) {
      const std::size_t end = std::min(i + kPackedAtOnce, kept_scans.size());
      ForEach((end - i + kShare - 1) / kShare, threads, [&](std::size_t share) {
        const std::size_t first = i + share * kShare;
        for (std::size_t one = first; one < std::min(first + kShare, end); ++one) {
          all_packed[one - i] = PackedRanges(kept_scans[one].scan);
        }
      });
    }
    const LaserScan& scan = kept_scans[i].scan;
    insert.Bind(Id(i)).Bind(Id(kept_scans[i].trajectory_index)).Bind(scan.stamp);
    BindPose(scan.T_robot_laser, insert);
    insert.Bind(scan.first_angle).Bind(scan.angle_step).Bind(double{scan.max_range});
    if (scan.T_odom_robot) {
      BindPose(*scan.T_odom_robot, insert);
    } else {
      insert.BindNull().BindNull().BindNull();
    }
    const std::string& packed = all_packed[i % kPackedAtOnce];
    insert.Bind(Id(scan.size())).BindBlob(packed).Bind(std::int64_t{Checksum(packed)}).Put();
  }
}

void WriteClouds(const std::vector<KeptCloud>& kept_clouds, const Database& database) {
  Statement insert(database, "INSERT INTO clouds VALUES (?,?,?)");
  for (std::size_t i = 0; i < kept_clouds.size(); ++i) {
    insert.Bind(Id(i)).Bind(Id(kept_clouds[i].trajectory_index));
    insert.BindBlob(*kept_clouds[i].packed).Put();
  }
}

void WriteTransits(const std::vector<TransitRecord>& transits, const Database& database) {
  Statement insert(database, "INSERT INTO transits VALUES (?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < transits.size(); ++i) {
    const TransitRecord& transit = transits[i];
    std::string sensors;
    for (const std::string& sensor : transit.by) sensors += (sensors.empty() ? "" : " ") + sensor;
    insert.Bind(Id(i)).Bind(transit.t_out).Bind(transit.t_in).Bind(transit.height_m);
    insert.Bind(transit.sigma_m).BindText(sensors).BindText(transit.open).Put();
  }
}

void WriteDrives(const std::vector<Drive>& drives, const Database& database) {
  Statement insert(database, "INSERT INTO drives VALUES (?,?,?,?,?,?,?)");
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const Drive& drive = drives[i];
    insert.Bind(Id(i)).BindText(drive.log).Bind(Id(drive.first_pose));
    insert.Bind(std::int64_t{drive.first_node}).Bind(drive.stamp_offset_s);
    insert.BindText(Name(drive.motion_source)).BindText(drive.reason).Put();
  }
}

std::int64_t OldestVersionFor(const BuildingMap& map) {
  const std::vector<Edge>& edges = map.graph.edges();
  if (std::any_of(edges.begin(), edges.end(),
                  [](const Edge& edge) { return edge.kind == EdgeKind::kHeading; })) {
    return kMapVersion;
  }
  return map.kept_clouds.empty() ? kMapVersionWithoutClouds : kMapVersionWithoutHeadings;
}

}  // namespace

void WriteMapFile(const MapOrigin& origin, const BuildingMap& result,
                  const std::filesystem::path& path) {
  try {
    Database database(path, OpenMode::kWrite);
    // Nobody sees the file before it is whole: it is written aside, as every export is.
    database.Run("PRAGMA page_size = 4096");
    database.Run("PRAGMA journal_mode = OFF");
    database.Run("PRAGMA synchronous = OFF");
    database.Run("PRAGMA secure_delete = ON");  // what is free holds nothing
    Transaction transaction(database);
    const std::int64_t version = OldestVersionFor(result);
    MakeTables(database, version);
    WriteOrigin(origin, result, database);
    WriteLog(result, database);
    WriteNodes(result.graph, database);
    WriteEdges(result.graph, database);
    WriteClosures(result.closures, database);
    WriteTrajectory(result.trajectory, database);
    WriteLogStamps(result, database);
    WriteScans(result.kept_scans, origin.options.threads, database);
    WriteTransits(result.transits, database);
    WriteDrives(result.drives, database);
    WriteAnnotations(result, database);
    if (version > kMapVersionWithoutClouds) WriteClouds(result.kept_clouds, database);
    Seal(database);
    transaction.Commit();
  } catch (const DatabaseError& error) {
    throw std::runtime_error("cannot write " + path.string() + ": " + error.what());
  }
}

}  // namespace masked_mapper
