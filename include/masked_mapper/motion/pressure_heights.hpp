// SPDX-License-Identifier: BSD-3-Clause
// Heights of a barometer over a whole drive, made fit for use: units found, spikes out, thinned to
// medians of short spells. The heights still drift with the weather.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

struct PressureHeightOptions {
  double pressure_pa_per_m = 12.0;  ///< Pa less per metre up, near sea level
  double max_height = 500.0;        ///< m from the median height; what is beyond is no reading
  double spike_height = 1.5;        ///< m, by which a lone spell may not leave its neighbours
};

/// One spell.
struct HeightSample {
  double stamp = 0.0;   ///< s
  double height = 0.0;  ///< m above an arbitrary zero
};

struct PressureHeights {
  std::vector<HeightSample> samples;  ///< by stamps; empty when the readings are of no use
  double sigma = 0.0;                 ///< m, noise of one sample
  std::vector<std::string> warnings;  ///< what was wrong with the readings, one line each
};

/// Readings in order of stamps, Pa. Hectopascals and kilopascals are recognised.
PressureHeights HeightsOfPressure(const std::vector<PressureReading>& readings,
                                  const PressureHeightOptions& options);

}  // namespace masked_mapper
