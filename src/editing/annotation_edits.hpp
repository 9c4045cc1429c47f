// SPDX-License-Identifier: BSD-3-Clause
// The edits that write into a map rather than mend it: places, areas, known points of a site.
// Their coordinates are those of the map as it was before all edits.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "edit_line.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Fails for a label that the map has not.
FloorId FloorOfEdit(const std::string& label, const EditLine& edit, const BuildingMap& map);

/// Letters, digits, `_`, `.` and `-`; may be a file's name.
bool IsName(const std::string& name);

class AnnotationEdits {
 public:
  explicit AnnotationEdits(const BuildingMap& before);

  // What each did, as a line for people.
  std::string NamePlaces(EditLine& edit, BuildingMap& map) const;
  std::string Draw(AreaKind kind, EditLine& edit, BuildingMap& map) const;
  std::string Anchor(EditLine& edit, const BuildingMap& map);

  void RenameFloors(const std::function<FloorId(FloorId)>& renamed);
  /// After the graph was solved again: what is written into the map stays with the node beside it.
  void Carry(BuildingMap& map);
  /// Into the frame of the anchors, if there are any; what is left over is told among the warnings.
  void MoveToAnchors(BuildingMap& map) const;

 private:
  struct KnownPoint {
    FloorId floor = 0;
    Eigen::Vector2d at_in_world;
    Eigen::Vector2d at_in_site;
  };

  Eigen::Vector2d Carried(FloorId floor, const Eigen::Vector2d& point,
                          const BuildingMap& map) const;

  std::vector<Pose2> T_world_robot_before_;  ///< by node
  std::vector<KnownPoint> anchors_;
};

}  // namespace masked_mapper
