// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <algorithm>

namespace masked_mapper {

const FloorInterval& FloorTimeline::At(double stamp) const {
  const auto after = std::upper_bound(
      intervals.begin() + 1, intervals.end(), stamp,
      [](double value, const FloorInterval& interval) { return value < interval.start; });
  return *(after - 1);
}

}  // namespace masked_mapper
