// SPDX-License-Identifier: BSD-3-Clause
// Where the heights of a barometer step: quick steps by short windows, and slower ones by longer
// windows in what is left when those are taken out.
#pragma once

#include <cstddef>
#include <vector>

#include "floor_pressure.hpp"
#include "pressure_heights.hpp"

namespace masked_mapper {

/// The heights move between the samples `first` and `last`, which themselves are at rest.
struct PressureStep {
  std::size_t first = 0;
  std::size_t last = 0;
  double climb = 0.0;  ///< m, roughly
};

/// Means of heights over spans of samples in constant time.
class MeanHeights {
 public:
  explicit MeanHeights(const std::vector<HeightSample>& samples) : sums_{0.0} {
    sums_.reserve(samples.size() + 1);
    for (const HeightSample& sample : samples) sums_.push_back(sums_.back() + sample.height);
  }
  /// Of [first, end).
  double operator()(std::size_t first, std::size_t end) const {
    return (sums_[end] - sums_[first]) / static_cast<double>(end - first);
  }

 private:
  std::vector<double> sums_;
};

/// In order, not overlapping.
std::vector<PressureStep> FindPressureSteps(const PressureHeights& heights,
                                            const FloorPressureOptions& options);

}  // namespace masked_mapper
