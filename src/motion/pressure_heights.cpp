// SPDX-License-Identifier: BSD-3-Clause
#include "pressure_heights.hpp"

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
double SpellDuration(const std::vector<PressureReading>& readings) {
  std::vector<double> periods;
  periods.reserve(readings.size());
  for (std::size_t i = 1; i < readings.size(); ++i) {
    periods.push_back(readings[i].stamp - readings[i - 1].stamp);
  }
  return periods.empty() ? 1.0 : std::clamp(4.0 * Median(std::move(periods)), 0.4, 1.0);
}

constexpr double kMost = 1e6;                  // of a reading; no unit makes air of more
constexpr std::size_t kToTellTheRate = 256;    // readings
constexpr std::size_t kMostOfASpell = 10'000;  // readings, whatever their stamps say

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
/// them. At either end of the drive it must be far from its neighbour as well: heights that move
/// there are of a ride that the log cuts.
std::vector<HeightSample> WithoutSpikes(const std::vector<HeightSample>& samples,
                                        double threshold) {
  constexpr std::size_t kAround = 5;
  std::vector<HeightSample> kept = samples;
  for (std::size_t i = 0; i < samples.size() && samples.size() >= kAround; ++i) {
    const std::size_t first = std::min(i < 2 ? 0 : i - 2, samples.size() - kAround);
    std::array<double, kAround> around;
    for (std::size_t k = 0; k < kAround; ++k) around[k] = samples[first + k].height;
    std::sort(around.begin(), around.end());
    const auto is_far_from = [&](double height) {
      return std::abs(samples[i].height - height) > threshold;
    };
    const bool is_first = i < 2;
    const bool is_last = i + 2 >= samples.size();
    if (is_first && !is_far_from(samples[i + 1].height)) continue;
    if (is_last && !is_far_from(samples[i - 1].height)) continue;
    if (is_far_from(around[2])) kept[i].height = around[2];
  }
  return kept;
}

/// The factor that makes pascals of readings around `median`; 0, with a warning, if none does.
double UnitOf(double lowest, double highest, double median, std::vector<std::string>& warnings) {
  if (lowest == highest) {
    warnings.push_back("pressure is constantly " + ShortText(lowest) + ": left out");
    return 0.0;
  }
  const double pa_per_unit = PascalPerUnit(median);
  if (pa_per_unit == 0.0) {
    warnings.push_back("pressure around " + ShortText(median) + " is none of air: left out");
  } else if (pa_per_unit != 1.0) {
    warnings.push_back("pressure around " + ShortText(median) + " is taken as " +
                       (pa_per_unit == 100.0 ? "hectopascals" : "kilopascals"));
  }
  return pa_per_unit;
}

}  // namespace

void PressureTrack::Observe(const PressureReading& reading) {
  ++observed_;
  const bool is_usable = reading.pressure_pa > 0.0 && reading.pressure_pa <= kMost &&
                         std::isfinite(reading.stamp) &&
                         (current_.empty() || reading.stamp >= current_.back().stamp);
  if (!is_usable) {
    ++refused_;
    return;
  }
  lowest_ = current_.empty() && spells_.empty() ? reading.pressure_pa
                                                : std::min(lowest_, reading.pressure_pa);
  highest_ = std::max(highest_, reading.pressure_pa);
  if (duration_s_ > 0.0) {
    Thin(reading);
  } else {
    current_.push_back(reading);
    if (current_.size() == kToTellTheRate) SettleDuration();
  }
}

void PressureTrack::SettleDuration() {
  duration_s_ = SpellDuration(current_);
  std::vector<PressureReading> readings;
  readings.swap(current_);
  for (const PressureReading& reading : readings) Thin(reading);
}

void PressureTrack::Thin(const PressureReading& reading) {
  if (!current_.empty() &&
      (reading.stamp >= current_.front().stamp + duration_s_ || current_.size() == kMostOfASpell)) {
    spells_.push_back(SpellOf(current_));
    current_.clear();
  }
  current_.push_back(reading);
}

PressureTrack::Spell PressureTrack::SpellOf(const std::vector<PressureReading>& readings) {
  std::vector<double> pressures;
  double stamps = 0.0;  // from the first, to lose no digits
  for (const PressureReading& reading : readings) {
    pressures.push_back(reading.pressure_pa);
    stamps += reading.stamp - readings.front().stamp;
  }
  std::sort(pressures.begin(), pressures.end());
  const std::size_t count = pressures.size();
  return {readings.front().stamp + stamps / static_cast<double>(count),
          0.5 * (pressures[(count - 1) / 2] + pressures[count / 2]), pressures.front(),
          pressures.back(), count};
}

PressureHeights PressureTrack::Heights(const PressureHeightOptions& options) const {
  PressureHeights result;
  if (observed_ == 0) return result;
  PressureTrack all = *this;
  if (all.duration_s_ == 0.0) all.SettleDuration();
  if (all.current_.empty()) {
    result.warnings.emplace_back("pressure is constantly 0: left out");
    return result;
  }
  all.spells_.push_back(SpellOf(all.current_));
  std::vector<double> pressures;
  for (const Spell& spell : all.spells_) pressures.push_back(spell.pressure);
  const double median = Median(std::move(pressures));
  const double pa_per_unit = UnitOf(lowest_, highest_, median, result.warnings);
  if (pa_per_unit == 0.0) return result;
  const double units_per_m =
      PascalPerMetre(median * pa_per_unit, options.pressure_pa_per_m) / pa_per_unit;
  std::size_t left_out = refused_;
  for (const Spell& spell : all.spells_) {
    const auto is_air = [&](double pressure) {
      return std::abs(median - pressure) / units_per_m <= options.max_height;
    };
    if (is_air(spell.pressure)) {
      result.samples.push_back({spell.stamp, (median - spell.pressure) / units_per_m});
      left_out += (is_air(spell.lowest) ? 0 : 1) + (is_air(spell.highest) ? 0 : 1);
    } else {
      left_out += spell.readings;
    }
  }
  if (left_out > 0) {
    // Of a spell with a sound median only its extremes are known.
    result.warnings.push_back("at least " + std::to_string(left_out) + " of " +
                              std::to_string(observed_) +
                              " pressure readings are none of air: left out");
  }
  if (observed_ - left_out < 2) {
    result.samples.clear();
    return result;
  }
  result.samples =
      WithoutSpikes(result.samples, std::max(options.spike_height, 6.0 * NoiseOf(result.samples)));
  result.sigma = NoiseOf(result.samples);
  return result;
}

}  // namespace masked_mapper
