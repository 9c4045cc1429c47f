// SPDX-License-Identifier: BSD-3-Clause
// Heights of a barometer over a whole drive, made fit for use: units found, spikes out, thinned to
// medians of short spells. The heights still drift with the weather.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

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

/// Readings over the drive, thinned to medians as they come.
class PressureTrack {
 public:
  /// Readings in order of stamps, Pa. Hectopascals and kilopascals are recognised.
  void Observe(const PressureReading& reading);

  PressureHeights Heights(const PressureHeightOptions& options) const;

  /// How much is kept: readings of the spell that grows, and one for every spell before.
  std::size_t kept() const { return current_.size() + spells_.size(); }

 private:
  /// The median of a spell's readings.
  struct Spell {
    double stamp = 0.0;     ///< s, mean of its readings
    double pressure = 0.0;  ///< in the log's unit
    double lowest = 0.0;    ///< of its readings
    double highest = 0.0;
    std::size_t readings = 0;
  };
  static Spell SpellOf(const std::vector<PressureReading>& readings);
  void SettleDuration();
  void Thin(const PressureReading& reading);

  double duration_s_ = 0.0;               ///< of a spell; 0: too few readings to tell
  std::vector<PressureReading> current_;  ///< of the spell that grows; at first, all
  std::vector<Spell> spells_;
  std::size_t observed_ = 0;
  std::size_t refused_ = 0;  ///< neither finite nor positive, or a step back in time
  double lowest_ = 0.0;      ///< of the readings taken, in the log's unit
  double highest_ = 0.0;
};

}  // namespace masked_mapper
