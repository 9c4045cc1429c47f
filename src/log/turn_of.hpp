// SPDX-License-Identifier: BSD-3-Clause
// Directions of many points. The library's arc tangent takes as long as all else that is done with
// a point, and differs from system to system.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace masked_mapper {

/// The direction as a share of a turn, in [0, 1] from straight behind by the right hand: atan2 over
/// 2 pi, and a half. Off by less than 1e-7, which is what single precision leaves of it. Of no
/// direction, no number.
inline float TurnOf(float y, float x) {
  // atan(a) / (2 pi a) over the square of a in [0, 1], through the Chebyshev points.
  constexpr std::array<float, 8> kSeries = {0.15915492177009583F,  -0.053049229085445404F,
                                            0.03177840635180473F,  -0.022286929190158844F,
                                            0.015706786885857582F, -0.009363045915961266F,
                                            0.003784787142649293F, -0.0007257134420797229F};
  const float along = std::abs(x);
  const float across = std::abs(y);
  const float less = std::min(along, across);
  const float more = std::max(along, across);
  const float ratio = less / more;
  const float square = ratio * ratio;
  float sum = kSeries.back();
  for (std::size_t i = kSeries.size() - 1; i-- > 0;) sum = sum * square + kSeries[i];
  float turn = sum * ratio;
  turn = across > along ? 0.25F - turn : turn;
  turn = x < 0.0F ? 0.5F - turn : turn;
  turn = y < 0.0F ? -turn : turn;
  return turn + 0.5F;
}

}  // namespace masked_mapper
