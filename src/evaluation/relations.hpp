// SPDX-License-Identifier: BSD-3-Clause
// The error of a trajectory against true relations between stamps (Kuemmerle et al. 2009): the
// translation and rotation left after taking the true motion out of the estimated one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "masked_mapper/evaluation/evaluation.hpp"
#include "stamped_trajectory.hpp"

namespace masked_mapper {

struct Relation {
  double stamp_a = 0.0;  ///< s
  double stamp_b = 0.0;  ///< s
  Pose2 T_a_b;           ///< true motion of the robot
};

/// Lines `t1 t2 x y z roll pitch yaw`; z, roll and pitch are read and not used. Throws InputError,
/// which names file and line.
std::vector<Relation> ReadRelations(const std::string& path);

RelationsError CompareWithRelations(const std::vector<StampedPose>& trajectory,
                                    const std::vector<Relation>& relations);

}  // namespace masked_mapper
