// SPDX-License-Identifier: BSD-3-Clause
// Mapping that survives its own end. Mapping is a function of the log, so that what is done so far
// is the number of observations that went in and the state that they left; from both it goes on
// and comes to the same map, bit for bit. Where checkpoints are kept is another's business: who
// keeps them implements CheckpointStore.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/mapping/log_survey.hpp"

namespace masked_mapper {

/// What a checkpoint holds beside the parts of the map that only grow.
struct CheckpointState {
  std::uint64_t observations = 0;  ///< of the log, that have gone in
  double progress = 0.0;           ///< share of the log, 0 to 1
  std::string bytes;               ///< for Unpack...() below and MaskedMapper::RestoreState()
};

/// The parts of a map in the making that only grow: what was once in them never changes.
struct GrownParts {
  std::vector<TrajectoryPose> trajectory;
  std::vector<KeptScan> kept_scans;
};

struct Checkpoint {
  CheckpointState state;
  GrownParts parts;
};

class CheckpointStore {
 public:
  virtual ~CheckpointStore() = default;
  /// The checkpoint to go on from; empty: there is none, mapping starts afresh. Asked once, before
  /// all else. Throws InputError when there is one that cannot be used.
  virtual std::optional<Checkpoint> Load() = 0;
  /// Whether it is time for the next one; asked after every scan.
  virtual bool IsDue() = 0;
  /// Keeps the state, and of `map` those of the grown parts that it does not have yet; the ones
  /// before stay good until all of it is kept. Throws std::runtime_error when that fails: mapping
  /// then goes on without checkpoints.
  virtual void Save(const CheckpointState& state, const BuildingMap& map) = 0;
  /// Mapping begins anew: the next Save() replaces all that is kept.
  virtual void StartOver() = 0;
};

/// A run of grown parts as bytes, and back. A damaged one throws StateError.
std::string PackPoses(const std::vector<TrajectoryPose>& poses, std::size_t first);
std::string PackScans(const std::vector<KeptScan>& scans, std::size_t first);
void AppendPoses(const std::string& bytes, GrownParts& parts);
void AppendScans(const std::string& bytes, GrownParts& parts);

/// What was found out about the log before mapping, as bytes, and back.
std::string PackSurvey(const LogSurvey& survey);
LogSurvey UnpackSurvey(const std::string& bytes);

}  // namespace masked_mapper
