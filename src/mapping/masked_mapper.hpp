// SPDX-License-Identifier: BSD-3-Clause
// The masked mapper: Algorithm 1 of the paper, one observation at a time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drive_motion.hpp"
#include "masked_mapper/loop_closure/loop_closer.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/mapping/checkpoint.hpp"
#include "masked_mapper/mapping/mapping_options.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"

namespace masked_mapper {

class MaskedMapper {
 public:
  /// `floors` says where the robot was when; it outlives the mapper.
  /// Throws InputError when `mask` is not a mask expression.
  MaskedMapper(const std::string& mask, const MappingOptions& options, const FloorTimeline& floors);

  /// Observations in order of stamps.
  void Observe(const Observation& observation);

  // The same in two parts. A thread may run ahead with the first of them: the map is what is made
  // of the scans, in their order.
  DriveMotion& motion() { return motion_; }
  void Observe(const MovedScan& moved);

  /// Ends the map: every scan gets its pose. The mapper is spent afterwards.
  BuildingMap Finish();

  const BuildingMap& result() const { return result_; }
  /// As settled for their source of motion.
  const MappingOptions& options() const { return options_; }

  // For checkpoints; all of this stands in checkpoint.cpp.
  /// Everything that the observations so far left behind, but for the parts that only grow and for
  /// the mask's memory.
  std::string SaveState() { return SaveState(motion_.SaveState()); }
  /// The same, where motion has run ahead; its state is that behind the scan observed last.
  std::string SaveState(std::string motion);
  /// To a mapper made with the same mask, options and floors, before any observation. Throws
  /// StateError.
  void RestoreState(const std::string& bytes, GrownParts parts);
  /// After that: the scans that had gone in before, in order, so that the mask remembers them.
  void RememberScan(const LaserScan& scan);

 private:
  template <class Archive>
  void SerializeState(Archive& archive);
  LaserScan StraightenedAt(const LaserScan& scan, std::size_t pose,
                           const Pose2& T_odom_robot) const;
  void ChangeFloor(const FloorInterval& interval, double stamp);
  NodeId AddNode(double stamp, FloorId floor, EdgeKind kind, KeptScanId scan = -1);
  KeptScanId Keep(const LaserScan& scan);
  void CloseLoops(NodeId new_node);
  void RecordPose(const LaserScan& scan, const FloorInterval& interval);
  bool IsNextKept() const;
  bool IsDueToBeKept(const FloorInterval& interval) const;

  MappingOptions options_;
  const FloorTimeline& floors_;
  DriveMotion motion_;
  std::unique_ptr<Mask> mask_;
  BuildingMap result_;
  CandidateSearch candidates_;
  LoopCloser closer_;  ///< works on result_

  Pose2 T_odom_robot_;                    ///< at the scan observed last, as T_node_robot_
  UncertainPose2 T_node_robot_;           ///< motion since the last node
  std::optional<NodeId> last_scan_node_;  ///< on this floor since it was entered
  bool in_transit_ = false;
  double travelled_since_kept_m_ = 0.0;
  std::size_t remembered_scans_ = 0;  ///< by RememberScan
};

}  // namespace masked_mapper
