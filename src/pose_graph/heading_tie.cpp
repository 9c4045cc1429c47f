// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/pose_graph/heading_tie.hpp"

namespace masked_mapper {
namespace {

constexpr double kAnywhere = 1e5;  // m; no way is so unsure

}  // namespace

Edge HeadingTie(NodeId from, NodeId to, double turn_rad, double sigma_rad) {
  Edge edge{from, to, {{0.0, 0.0, WrapAngle(turn_rad)}, Eigen::Matrix3d::Zero()}};
  edge.T_from_to.covariance.diagonal() << kAnywhere * kAnywhere, kAnywhere * kAnywhere,
      sigma_rad * sigma_rad;
  return edge;
}

bool IsHeadingTie(const Edge& edge) {
  return edge.T_from_to.covariance(0, 0) >= kAnywhere * kAnywhere;
}

}  // namespace masked_mapper
