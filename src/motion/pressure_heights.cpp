// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/pressure_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "masked_mapper/text/number_text.hpp"

#include "masked_mapper/geometry/median.hpp"

namespace masked_mapper {
namespace {

/// Pascal per unit of readings around `median`, 0 when no unit makes air pressure of them. Ours.
double PascalPerUnit(double median) {
  constexpr double kThinnestAir = 30'000.0;
  constexpr double kThickestAir = 115'000.0;
  for (const double scale : {1.0, 100.0, 1000.0}) {
    if (median * scale >= kThinnestAir && median * scale <= kThickestAir) return scale;
  }
  return 0.0;
}

/// The field's figure of 12 Pa per metre serves wherever the weather might have made the pressure;
/// on a mountain the air is thinner (ours).
double PascalPerMetre(double median_pa, double at_sea_level) {
  return median_pa >= 95'000.0 ? at_sea_level : at_sea_level * median_pa / 101'325.0;
}

/// Spells of a second, or shorter where enough readings fall into less.
double SpellDuration(const std::vector<HeightSample>& samples) {
  std::vector<double> periods;
  periods.reserve(samples.size());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    periods.push_back(samples[i].stamp - samples[i - 1].stamp);
  }
  return std::clamp(4.0 * Median(std::move(periods)), 0.4, 1.0);
}

std::vector<HeightSample> MediansOfSpells(const std::vector<HeightSample>& samples) {
  const double duration = SpellDuration(samples);
  std::vector<HeightSample> spells;
  std::vector<double> heights;
  for (std::size_t i = 0; i < samples.size();) {
    heights.clear();
    double stamps = 0.0;  // from the first, to lose no digits
    std::size_t j = i;
    for (; j < samples.size() && samples[j].stamp < samples[i].stamp + duration; ++j) {
      heights.push_back(samples[j].height);
      stamps += samples[j].stamp - samples[i].stamp;
    }
    std::sort(heights.begin(), heights.end());
    const double median = 0.5 * (heights[(heights.size() - 1) / 2] + heights[heights.size() / 2]);
    spells.push_back({samples[i].stamp + stamps / static_cast<double>(heights.size()), median});
    i = j;
  }
  return spells;
}

/// Deviation of the samples' noise, from second differences, which neither weather nor most of a
/// ride reaches.
double NoiseOf(const std::vector<HeightSample>& samples) {
  if (samples.size() < 3) return 0.0;
  std::vector<double> bends;
  bends.reserve(samples.size());
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    bends.push_back(
        std::abs(samples[i - 1].height - 2.0 * samples[i].height + samples[i + 1].height));
  }
  return Median(std::move(bends)) / 0.6745 / std::sqrt(6.0);
}

/// A sample, or two in a row, far from the three or more around it is a spike, and is put among
/// them.
std::vector<HeightSample> WithoutSpikes(const std::vector<HeightSample>& samples,
                                        double threshold) {
  constexpr std::size_t kAround = 5;
  std::vector<HeightSample> kept = samples;
  for (std::size_t i = 0; i < samples.size() && samples.size() >= kAround; ++i) {
    const std::size_t first = std::min(i < 2 ? 0 : i - 2, samples.size() - kAround);
    std::array<double, kAround> around;
    for (std::size_t k = 0; k < kAround; ++k) around[k] = samples[first + k].height;
    std::sort(around.begin(), around.end());
    if (std::abs(samples[i].height - around[2]) > threshold) kept[i].height = around[2];
  }
  return kept;
}

}  // namespace

PressureHeights HeightsOfPressure(const std::vector<PressureReading>& readings,
                                  const PressureHeightOptions& options) {
  PressureHeights result;
  if (readings.empty()) return result;
  std::vector<double> values;
  for (const PressureReading& reading : readings) {
    if (reading.pressure_pa > 0.0 && std::isfinite(reading.pressure_pa)) {
      values.push_back(reading.pressure_pa);
    }
  }
  if (values.empty()) {
    result.warnings.emplace_back("pressure is constantly 0: left out");
    return result;
  }
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  if (*lowest == *highest) {
    result.warnings.push_back("pressure is constantly " + ShortText(*lowest) + ": left out");
    return result;
  }
  const double median = Median(values);
  const double pa_per_unit = PascalPerUnit(median);
  if (pa_per_unit == 0.0) {
    result.warnings.push_back("pressure around " + ShortText(median) + " is none of air: left out");
    return result;
  }
  if (pa_per_unit != 1.0) {
    result.warnings.push_back("pressure around " + ShortText(median) + " is taken as " +
                              (pa_per_unit == 100.0 ? "hectopascals" : "kilopascals"));
  }
  const double units_per_m =
      PascalPerMetre(median * pa_per_unit, options.pressure_pa_per_m) / pa_per_unit;
  std::vector<HeightSample> samples;
  samples.reserve(values.size());
  for (const PressureReading& reading : readings) {
    const double height = (median - reading.pressure_pa) / units_per_m;
    const bool is_in_order = samples.empty() || reading.stamp >= samples.back().stamp;
    if (std::isfinite(reading.stamp) && is_in_order && std::abs(height) <= options.max_height) {
      samples.push_back({reading.stamp, height});
    }
  }
  if (samples.size() < readings.size()) {
    result.warnings.push_back(std::to_string(readings.size() - samples.size()) + " of " +
                              std::to_string(readings.size()) +
                              " pressure readings are none of air: left out");
  }
  if (samples.size() < 2) return result;
  result.samples = MediansOfSpells(samples);
  result.samples =
      WithoutSpikes(result.samples, std::max(options.spike_height, 6.0 * NoiseOf(result.samples)));
  result.sigma = NoiseOf(result.samples);
  return result;
}

}  // namespace masked_mapper
