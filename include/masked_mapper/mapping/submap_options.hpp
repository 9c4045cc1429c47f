// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace masked_mapper {

struct SubmapOptions {
  double half_length_m = 3.0;      ///< travel before and after the node
  double min_inlier_share = 0.65;  ///< of a scan that fits
  double max_correction_m = 0.4;   ///< a refinement that moves farther is not one
  double max_correction_deg = 4.0;
  double sigma_floor_m = 0.01;  ///< the motion path within a submap is not perfect
  double sigma_floor_deg = 0.05;
  double prior_weight = 0.05;  ///< say of the coarse match, beside the points'
  std::size_t cached = 48;     ///< submaps kept
};

}  // namespace masked_mapper
