// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/checkpoint_file.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "database.hpp"
#include "log_identity.hpp"
#include "masked_mapper/sensor/state_archive.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "packed_bytes.hpp"
#include "unfinished_folder.hpp"

namespace fs = std::filesystem;

namespace masked_mapper {
namespace {

constexpr std::int64_t kCheckpointApplicationId = 0x4d6d636b;  // "Mmck"
/// To be raised whenever the state of anything changes its shape. A checkpoint lives for hours and
/// is not upgraded.
constexpr std::int64_t kCheckpointVersion = 11;

/// A checkpoint may take this share of the time to the next one.
constexpr double kShare = 0.03;

enum class PieceKind : std::int64_t { kPoses, kScans };

}  // namespace

/// The open file, and how much of the grown parts is in it.
class CheckpointFile::Impl {
 public:
  explicit Impl(const fs::path& file) : database_(file, OpenMode::kWrite) {
    // The file is this program's alone until it ends, which also does without a file of shared
    // memory. A commit is in the log of the write-ahead journal, whatever ends the program; only a
    // loss of power may take the last ones along.
    database_.Run("PRAGMA locking_mode = EXCLUSIVE");
    database_.Text("PRAGMA journal_mode = WAL");
    database_.Run("PRAGMA synchronous = NORMAL");
  }

  void Make(const NamedValues& key, const std::string& log_identity) {
    Transaction transaction(database_);
    database_.Run(
        "CREATE TABLE run(id INTEGER PRIMARY KEY, key TEXT NOT NULL, value TEXT NOT NULL)"
        " STRICT");
    database_.Run("CREATE TABLE log(id INTEGER PRIMARY KEY, identity TEXT NOT NULL) STRICT");
    database_.Run(
        "CREATE TABLE pieces(id INTEGER PRIMARY KEY, kind INTEGER NOT NULL,"
        " bytes BLOB NOT NULL, checksum INTEGER NOT NULL) STRICT");
    database_.Run(
        "CREATE TABLE state(id INTEGER PRIMARY KEY, observations INTEGER NOT NULL,"
        " progress REAL NOT NULL, bytes BLOB NOT NULL, checksum INTEGER NOT NULL)"
        " STRICT");
    database_.Run("PRAGMA application_id = " + std::to_string(kCheckpointApplicationId));
    database_.Run("PRAGMA user_version = " + std::to_string(kCheckpointVersion));
    Statement run(database_, "INSERT INTO run(key, value) VALUES (?,?)");
    for (const auto& [name, value] : key) run.BindText(name).BindText(value).Put();
    Statement(database_, "INSERT INTO log(identity) VALUES (?)").BindText(log_identity).Put();
    transaction.Commit();
  }

  bool IsOurs() {
    return database_.Number("PRAGMA application_id") == kCheckpointApplicationId &&
           database_.Number("PRAGMA user_version") == kCheckpointVersion;
  }

  bool IsEmpty() { return database_.Number("SELECT count(*) FROM sqlite_master") == 0; }

  NamedValues ReadKey() {
    NamedValues key;
    Statement rows(database_, "SELECT key, value FROM run ORDER BY id");
    while (rows.Next()) {
      std::string name(rows.Text());
      key.emplace_back(std::move(name), rows.Text());
    }
    return key;
  }

  std::string ReadLogIdentity() { return database_.Text("SELECT identity FROM log"); }

  std::optional<Checkpoint> Read() {
    Checkpoint checkpoint;
    Statement state(database_,
                    "SELECT observations, progress, bytes, checksum FROM state WHERE id = 0");
    if (!state.Next()) return std::nullopt;
    checkpoint.state.observations = static_cast<std::uint64_t>(state.Integer());
    checkpoint.state.progress = state.Real();
    checkpoint.state.bytes = TakeBytes(state);
    Statement pieces(database_, "SELECT kind, bytes, checksum FROM pieces ORDER BY id");
    while (pieces.Next()) {
      const auto kind = static_cast<PieceKind>(pieces.Integer());
      const std::string bytes = TakeBytes(pieces);
      switch (kind) {
        case PieceKind::kPoses:
          AppendPoses(bytes, checkpoint.parts);
          break;
        case PieceKind::kScans:
          AppendScans(bytes, checkpoint.parts);
          break;
        default:
          throw DatabaseError("a piece of no known kind");
      }
    }
    poses_ = checkpoint.parts.trajectory.size();
    scans_ = checkpoint.parts.kept_scans.size();
    return checkpoint;
  }

  void Write(const CheckpointState& state, const BuildingMap& map) {
    Transaction transaction(database_);
    if (starts_over_) database_.Run("DELETE FROM pieces");
    WritePiece(PieceKind::kPoses, PackPoses(map.trajectory, poses_));
    WritePiece(PieceKind::kScans, PackScans(map.kept_scans, scans_));
    Statement write(database_, "INSERT OR REPLACE INTO state VALUES (0,?,?,?,?)");
    write.Bind(static_cast<std::int64_t>(state.observations)).Bind(state.progress);
    write.BindBlob(state.bytes).Bind(std::int64_t{Checksum(state.bytes)}).Put();
    transaction.Commit();
    poses_ = map.trajectory.size();
    scans_ = map.kept_scans.size();
    starts_over_ = false;
  }

  void StartOver() {
    poses_ = scans_ = 0;
    starts_over_ = true;
  }

 private:
  static std::string TakeBytes(Statement& row) {
    std::string bytes(row.Blob());
    if (row.Integer() != std::int64_t{Checksum(bytes)}) {
      throw DatabaseError("bytes that do not fit their checksum");
    }
    return bytes;
  }

  void WritePiece(PieceKind kind, const std::string& bytes) {
    if (bytes.empty()) return;
    Statement insert(database_, "INSERT INTO pieces(kind, bytes, checksum) VALUES (?,?,?)");
    insert.Bind(static_cast<std::int64_t>(kind)).BindBlob(bytes);
    insert.Bind(std::int64_t{Checksum(bytes)}).Put();
  }

  Database database_;
  std::size_t poses_ = 0;
  std::size_t scans_ = 0;
  bool starts_over_ = false;
};

CheckpointFile::CheckpointFile(const fs::path& out, const MapOrigin& origin, double interval_s,
                               bool resume, std::size_t drive)
    : folder_(UnfinishedFolder(out)),
      file_(folder_ / CheckpointFileName(drive)),
      origin_(origin),
      interval_(
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval_s))),
      due_(interval_s > 0.0 ? Clock::now() + interval_ : Clock::time_point::max()),
      resume_(resume) {}

CheckpointFile::~CheckpointFile() = default;

bool CheckpointFile::Exists(const fs::path& out) {
  // Of any drive: a short one may be done without a trace before the next is kept.
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(UnfinishedFolder(out), missing)) {
    const fs::path ending = entry.path().extension();
    if (ending == kCheckpointEnding || ending == kFinishedEnding) return true;
  }
  return false;
}

std::optional<Checkpoint> CheckpointFile::Load() {
  if (!resume_ || !fs::exists(file_)) return std::nullopt;
  const std::string name = file_.string();
  try {
    auto opened = std::make_unique<Impl>(file_);
    if (opened->IsEmpty()) return std::nullopt;
    if (!opened->IsOurs()) {
      throw InputError(name + ": written by another version of the program; --force starts afresh");
    }
    const std::string difference = FirstDifference(opened->ReadKey(), KeyOf(origin_));
    if (!difference.empty()) {
      throw InputError("the unfinished map was made otherwise: " + difference +
                       "; --force starts afresh");
    }
    CheckUnchanged(origin_, opened->ReadLogIdentity());
    std::optional<Checkpoint> checkpoint = opened->Read();
    if (!checkpoint) return std::nullopt;
    impl_ = std::move(opened);
    has_checkpoint_ = true;
    progress_ = checkpoint->state.progress;
    if (due_ != Clock::time_point::max()) due_ = Clock::now() + interval_;
    return checkpoint;
  } catch (const DatabaseError& error) {
    if (error.is_busy) throw InputError(name + ": another run is at work on this map");
    throw InputError(name + ": damaged, cannot be used: " + error.what() +
                     "; --force starts afresh");
  } catch (const StateError& error) {
    throw InputError(name + ": damaged, cannot be used: " + error.what() +
                     "; --force starts afresh");
  }
}

bool CheckpointFile::IsDue() { return Clock::now() >= due_; }

void CheckpointFile::Save(const CheckpointState& state, const BuildingMap& map) {
  const Clock::time_point start = Clock::now();
  try {
    if (!impl_) {
      fs::create_directories(folder_);
      for (const char* ending : {"", "-wal", "-journal", "-shm"}) {
        fs::remove(file_.string() + ending);
      }
      auto made = std::make_unique<Impl>(file_);
      made->Make(KeyOf(origin_), IdentityText(origin_));
      impl_ = std::move(made);
    }
    impl_->Write(state, map);
  } catch (const DatabaseError& error) {
    throw std::runtime_error("cannot write " + file_.string() + ": " + error.what());
  }
  has_checkpoint_ = true;
  progress_ = state.progress;
  const Clock::duration took = Clock::now() - start;
  const auto rest =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(took) / kShare);
  if (due_ != Clock::time_point::max()) due_ = Clock::now() + std::max(interval_, rest);
}

void CheckpointFile::StartOver() {
  if (impl_) impl_->StartOver();
}

void CheckpointFile::Remove() {
  impl_.reset();
  has_checkpoint_ = false;
  RemoveUnfinished(folder_);
}

}  // namespace masked_mapper
