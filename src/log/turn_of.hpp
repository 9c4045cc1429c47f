// SPDX-License-Identifier: BSD-3-Clause
// Directions of many points. The library's arc tangent takes as long as all else that is done with
// a point, and differs from system to system.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace masked_mapper {

// Four at a time, in the compilers' own vectors: SSE2, NEON or plain code alike.
constexpr std::size_t kTurnsAtOnce = 4;
using Floats __attribute__((vector_size(16))) = float;
using FloatBits __attribute__((vector_size(16))) = std::int32_t;

inline Floats Abs(const Floats& numbers) {
  FloatBits bits;
  std::memcpy(&bits, &numbers, sizeof(bits));
  bits &= 0x7fffffff;
  Floats without_sign;
  std::memcpy(&without_sign, &bits, sizeof(bits));
  return without_sign;
}

/// The directions as shares of a turn, in [0, 1] from straight behind by the right hand: atan2 over
/// 2 pi, and a half. Off by less than 1e-7, which is what single precision leaves of it. Of no
/// direction, no number.
inline Floats TurnsOf(const Floats& y, const Floats& x) {
  // atan(a) / (2 pi a) over the square of a in [0, 1], through the Chebyshev points.
  constexpr std::array<float, 8> kSeries = {0.15915492177009583F,  -0.053049229085445404F,
                                            0.03177840635180473F,  -0.022286929190158844F,
                                            0.015706786885857582F, -0.009363045915961266F,
                                            0.003784787142649293F, -0.0007257134420797229F};
  const Floats along = Abs(x);
  const Floats across = Abs(y);
  const FloatBits is_steep = across > along;
  const Floats ratio = (is_steep ? along : across) / (is_steep ? across : along);
  const Floats square = ratio * ratio;
  Floats sum = Floats{} + kSeries.back();
  for (std::size_t i = kSeries.size() - 1; i-- > 0;) sum = sum * square + kSeries[i];
  Floats turns = sum * ratio;
  turns = is_steep ? 0.25F - turns : turns;
  turns = x < 0.0F ? 0.5F - turns : turns;
  turns = y < 0.0F ? -turns : turns;
  return turns + 0.5F;
}

}  // namespace masked_mapper
