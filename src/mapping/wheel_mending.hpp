// SPDX-License-Identifier: BSD-3-Clause
// What is done about wheels that scans found to lie, and how it is told.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/motion/wheel_check.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"
#include "unbroken_way.hpp"

namespace masked_mapper {

struct WheelMending {
  OdometryMending mending;
  std::vector<SensorFinding> findings;
};

std::string InWords(const FalseRest& rest);

/// `log`: the time of its scans.
WheelMending MendingOf(const WheelFault& fault, const std::vector<FalseRest>& rests,
                       const TimeSpan& log);

/// What was found in a log that is mended by `wheels` already.
void Add(const WheelMending& more, WheelMending* wheels);

/// A motion that no wheels measured is told, but for what `mending` left out, which is told
/// already.
void AddSilences(const std::vector<UnbrokenWay::Silence>& silences, const OdometryMending& mending,
                 std::vector<SensorFinding>* findings);

}  // namespace masked_mapper
