// SPDX-License-Identifier: BSD-3-Clause
#include "schema.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "packed_bytes.hpp"

namespace masked_mapper {
namespace {

struct Table {
  const char* name;
  const char* columns;
};

// Every table has a key of its own: rows are read, and their checksums taken, in its order. Numbers
// are ANY, not REAL: SQLite keeps a whole REAL as an integer, and a zero would lose its sign.
constexpr std::array<Table, 19> kTables = {{
    {"run", "id INTEGER PRIMARY KEY, key TEXT NOT NULL, value TEXT NOT NULL"},
    {"options", "id INTEGER PRIMARY KEY, key TEXT NOT NULL, value TEXT NOT NULL"},
    {"log_statistics", "id INTEGER PRIMARY KEY, key TEXT NOT NULL, value ANY NOT NULL"},
    {"other_messages", "id INTEGER PRIMARY KEY, name TEXT NOT NULL, count INTEGER NOT NULL"},
    {"warnings", "id INTEGER PRIMARY KEY, text TEXT NOT NULL"},
    {"floors",
     "id INTEGER PRIMARY KEY, label TEXT NOT NULL, elevation ANY NOT NULL,"
     " elevation_sigma ANY NOT NULL, elevation_measured INTEGER NOT NULL,"
     " label_given INTEGER NOT NULL"},
    {"nodes",
     "id INTEGER PRIMARY KEY, stamp ANY NOT NULL, floor INTEGER NOT NULL REFERENCES floors(id),"
     " odom_x ANY NOT NULL, odom_y ANY NOT NULL, odom_theta ANY NOT NULL,"
     " world_x ANY NOT NULL, world_y ANY NOT NULL, world_theta ANY NOT NULL,"
     " scan INTEGER"},
    {"edges",
     "id INTEGER PRIMARY KEY, from_node INTEGER NOT NULL REFERENCES nodes(id),"
     " to_node INTEGER NOT NULL REFERENCES nodes(id), kind TEXT NOT NULL,"
     " x ANY NOT NULL, y ANY NOT NULL, theta ANY NOT NULL, covariance BLOB NOT NULL,"
     " closure INTEGER"},
    {"closures",
     "id INTEGER PRIMARY KEY, older INTEGER NOT NULL REFERENCES nodes(id),"
     " newer INTEGER NOT NULL REFERENCES nodes(id),"
     " x ANY NOT NULL, y ANY NOT NULL, theta ANY NOT NULL, covariance BLOB NOT NULL,"
     " score ANY NOT NULL, mahalanobis ANY NOT NULL, agreement ANY NOT NULL,"
     " votes INTEGER NOT NULL, state TEXT NOT NULL, reason TEXT NOT NULL"},
    {"trajectory",
     "id INTEGER PRIMARY KEY, pose_count INTEGER NOT NULL, poses BLOB NOT NULL,"
     " poses_checksum INTEGER NOT NULL"},
    {"scans",
     "id INTEGER PRIMARY KEY, trajectory_index INTEGER NOT NULL, stamp ANY NOT NULL,"
     " laser_x ANY NOT NULL, laser_y ANY NOT NULL, laser_theta ANY NOT NULL,"
     " first_angle ANY NOT NULL, angle_step ANY NOT NULL, max_range ANY NOT NULL,"
     " odom_x ANY, odom_y ANY, odom_theta ANY,"
     " beam_count INTEGER NOT NULL, ranges BLOB NOT NULL, ranges_checksum INTEGER NOT NULL"},
    {"log_stamps", "id INTEGER PRIMARY KEY, stamp ANY NOT NULL"},
    {"findings",
     "id INTEGER PRIMARY KEY, what TEXT NOT NULL, value ANY NOT NULL, sigma ANY NOT NULL,"
     " t_a ANY NOT NULL, t_b ANY NOT NULL, consequence TEXT NOT NULL"},
    {"transits",
     "id INTEGER PRIMARY KEY, t_out ANY NOT NULL, t_in ANY NOT NULL, height_m ANY NOT NULL,"
     " sigma_m ANY NOT NULL, sensors TEXT NOT NULL, open TEXT NOT NULL"},
    {"drives",
     "id INTEGER PRIMARY KEY, log TEXT NOT NULL, first_pose INTEGER NOT NULL,"
     " first_node INTEGER NOT NULL REFERENCES nodes(id), stamp_offset ANY NOT NULL,"
     " motion_source TEXT NOT NULL, reason TEXT NOT NULL"},
    {"places",
     "id INTEGER PRIMARY KEY, name TEXT NOT NULL, floor INTEGER NOT NULL REFERENCES floors(id),"
     " x ANY NOT NULL, y ANY NOT NULL"},
    {"areas",
     "id INTEGER PRIMARY KEY, kind TEXT NOT NULL, floor INTEGER NOT NULL REFERENCES floors(id),"
     " corners BLOB NOT NULL"},
    {"clouds", "id INTEGER PRIMARY KEY, trajectory_index INTEGER NOT NULL, packed BLOB NOT NULL"},
    {"content",
     "id INTEGER PRIMARY KEY, name TEXT NOT NULL, row_count INTEGER NOT NULL,"
     " checksum INTEGER NOT NULL"},
}};

// Version 1 knew one log, and nothing of who had named a floor; version 2 no stamps but its own,
// and nothing of what was found of sensors.
constexpr const char* kFloorsOfVersion1 =
    "id INTEGER PRIMARY KEY, label TEXT NOT NULL, elevation ANY NOT NULL,"
    " elevation_sigma ANY NOT NULL, elevation_measured INTEGER NOT NULL";

// Version 2 had the points of a node's scan beside the scans that were kept.
constexpr const char* kNodesOfVersion2 =
    "id INTEGER PRIMARY KEY, stamp ANY NOT NULL, floor INTEGER NOT NULL REFERENCES floors(id),"
    " odom_x ANY NOT NULL, odom_y ANY NOT NULL, odom_theta ANY NOT NULL,"
    " world_x ANY NOT NULL, world_y ANY NOT NULL, world_theta ANY NOT NULL,"
    " point_count INTEGER, points BLOB, points_checksum INTEGER";

// Version 2 knew closures from the newer node to the older, and edges did not say of which they
// are.
constexpr const char* kEdgesOfVersion2 =
    "id INTEGER PRIMARY KEY, from_node INTEGER NOT NULL REFERENCES nodes(id),"
    " to_node INTEGER NOT NULL REFERENCES nodes(id), kind TEXT NOT NULL,"
    " x ANY NOT NULL, y ANY NOT NULL, theta ANY NOT NULL, covariance BLOB NOT NULL";
constexpr Table kAttemptsOfVersion2 = {
    "attempts",
    "id INTEGER PRIMARY KEY, a INTEGER NOT NULL REFERENCES nodes(id),"
    " b INTEGER NOT NULL REFERENCES nodes(id),"
    " x ANY NOT NULL, y ANY NOT NULL, theta ANY NOT NULL, covariance BLOB NOT NULL,"
    " score ANY NOT NULL, mahalanobis ANY NOT NULL, agreement ANY NOT NULL,"
    " votes INTEGER NOT NULL, state TEXT NOT NULL, reason TEXT NOT NULL"};

std::vector<Table> TablesOf(std::int64_t version) {
  std::vector<Table> tables;
  for (Table table : kTables) {
    const std::string_view name = table.name;
    if (version <= 1 && name == "drives") continue;
    if (version <= 2 && (name == "log_stamps" || name == "findings")) continue;
    const bool is_of_version_4 = name == "transits" || name == "places" || name == "areas";
    if (version <= 3 && is_of_version_4) continue;
    if (version <= kMapVersionWithoutClouds && name == "clouds") continue;
    if (version <= 1 && name == "floors") table.columns = kFloorsOfVersion1;
    if (version <= 2 && name == "nodes") table.columns = kNodesOfVersion2;
    if (version <= 2 && name == "edges") table.columns = kEdgesOfVersion2;
    if (version <= 2 && name == "closures") table = kAttemptsOfVersion2;
    tables.push_back(table);
  }
  return tables;
}

std::string CreateStatement(const Table& table) {
  return std::string("CREATE TABLE ") + table.name + "(" + table.columns + ") STRICT";
}

struct RowDigest {
  std::int64_t rows = 0;
  std::uint32_t checksum = 0;
};

// Every value counts with its type, and text and blobs with their length, so that nothing can move
// from one value to the next unnoticed.
RowDigest DigestOf(const Database& database, const std::string& table) {
  Statement rows(database, "SELECT * FROM " + table + " ORDER BY id");
  RowDigest digest;
  std::string head;
  while (rows.Next()) {
    ++digest.rows;
    for (int column = 0; column < rows.columns(); ++column) {
      const ValueType type = rows.NextType();
      head.assign(1, static_cast<char>(type));
      std::string_view body;
      switch (type) {
        case ValueType::kNull:
          rows.Skip();
          break;
        case ValueType::kInteger:
          AppendBytes(rows.Integer(), head);
          break;
        case ValueType::kReal:
          AppendBytes(rows.Real(), head);
          break;
        case ValueType::kText:
          body = rows.Text();
          AppendBytes(std::uint64_t{body.size()}, head);
          break;
        case ValueType::kBlob:
          body = rows.Blob();
          AppendBytes(std::uint64_t{body.size()}, head);
          break;
      }
      digest.checksum = Checksum(body, Checksum(head, digest.checksum));
    }
  }
  return digest;
}

// A floor that is not called by its place among the others was named by somebody.
void NoteGivenLabels(Database& database) {
  std::vector<FloorLevel> levels;
  std::vector<std::string> labels;
  Statement rows(database, "SELECT label, elevation FROM floors ORDER BY id");
  while (rows.Next()) {
    labels.emplace_back(rows.Text());
    levels.emplace_back();
    levels.back().elevation = rows.Real();
    if (!std::isfinite(levels.back().elevation)) throw DatabaseError("a floor without a height");
  }
  if (levels.empty()) return;
  const std::vector<std::string> names = FloorNames(levels);
  Statement note(database, "UPDATE floors SET label_given = 1 WHERE id = ?");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != labels[i]) note.Bind(static_cast<std::int64_t>(i)).Put();
  }
}

}  // namespace

void MakeTables(Database& database, std::int64_t version) {
  for (const Table& table : TablesOf(version)) database.Run(CreateStatement(table));
  database.Run("PRAGMA application_id = " + std::to_string(kMapApplicationId));
  database.Run("PRAGMA user_version = " + std::to_string(version));
}

void Seal(Database& database) {
  const std::vector<Table> tables = TablesOf(database.Number("PRAGMA user_version"));
  Statement insert(database, "INSERT INTO content VALUES (?,?,?,?)");
  for (std::size_t i = 0; i + 1 < tables.size(); ++i) {
    const RowDigest digest = DigestOf(database, tables[i].name);
    insert.Bind(static_cast<std::int64_t>(i)).BindText(tables[i].name);
    insert.Bind(digest.rows).Bind(std::int64_t{digest.checksum}).Put();
  }
}

void CheckSeal(Database& database, std::int64_t version) {
  const std::vector<Table> tables = TablesOf(version);
  // Tables first: what is not ours (a view, an index, a trigger) must not be run.
  Statement schema(database, "SELECT sql FROM sqlite_master ORDER BY rowid");
  std::size_t found = 0;
  for (; schema.Next(); ++found) {
    if (found == tables.size() || schema.NextType() != ValueType::kText ||
        schema.Text() != CreateStatement(tables[found])) {
      throw DatabaseError("its tables are not those of a saved map");
    }
  }
  if (found != tables.size()) throw DatabaseError("its tables are not those of a saved map");
  if (database.Text("PRAGMA integrity_check(1)") != "ok") {
    throw DatabaseError("its pages contradict each other");
  }
  Statement content(database, "SELECT name, row_count, checksum FROM content ORDER BY id");
  std::size_t checked = 0;
  for (; content.Next(); ++checked) {
    const std::string name(content.Text());
    if (checked + 1 >= tables.size() || name != tables[checked].name) {
      throw DatabaseError("its table of contents is not that of a saved map");
    }
    const RowDigest digest = DigestOf(database, name);
    const bool rows_agree = content.Integer() == digest.rows;
    if (!rows_agree || content.Integer() != std::int64_t{digest.checksum}) {
      throw DatabaseError("the rows of table " + name + " have changed since they were written");
    }
  }
  if (checked + 1 != tables.size()) throw DatabaseError("its table of contents is cut off");
}

// The columns are added where the newest version has them: rows are read by place.
void Upgrade(Database& database, std::int64_t version) {
  const auto make = [&database](std::string_view name) {
    for (const Table& table : kTables) {
      if (table.name == name) database.Run(CreateStatement(table));
    }
  };
  for (const char* name : {"transits", "places", "areas"}) make(name);
  if (version <= 2) {
    database.Run("ALTER TABLE edges ADD COLUMN closure INTEGER");
    make("log_stamps");
    make("findings");
  }
  if (version >= 2) return;
  database.Run("ALTER TABLE floors ADD COLUMN label_given INTEGER NOT NULL DEFAULT 0");
  make("drives");
  NoteGivenLabels(database);
  if (database.Number("SELECT count(*) FROM nodes") == 0) return;
  database.Run(
      "INSERT INTO drives SELECT 0, (SELECT value FROM run WHERE key = 'log'), 0, 0, 0.0,"
      " (SELECT value FROM run WHERE key = 'motion_source'), ''");
}

}  // namespace masked_mapper
