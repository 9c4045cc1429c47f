// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/trajectory.hpp"

namespace masked_mapper {

void MoveMap(const Pose2& T_new_world, BuildingMap& map) {
  for (std::size_t i = 0; i < map.graph.nodes().size(); ++i) {
    map.graph.MoveNode(static_cast<NodeId>(i), T_new_world);
  }
  for (TrajectoryPose& pose : map.trajectory) {
    pose.T_odom_robot = T_new_world * pose.T_odom_robot;
    pose.T_world_robot = T_new_world * pose.T_world_robot;
  }
  for (NamedPlace& place : map.places) place.at_in_world = T_new_world * place.at_in_world;
  for (Area& area : map.areas) {
    for (Eigen::Vector2d& corner : area.corners_in_world) corner = T_new_world * corner;
  }
}

}  // namespace masked_mapper
