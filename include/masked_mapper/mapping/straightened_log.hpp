// SPDX-License-Identifier: BSD-3-Clause
// A log as it is mapped: with the scans put straight that the motion of the robot had bent.
#pragma once

#include <memory>

#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/motion/sweep_straightener.hpp"

namespace masked_mapper {

/// A pass from the beginning. Without wheels scans come as they are, with the time of their beams.
std::unique_ptr<LogReader> ReadStraightened(const LogSource& source, const SweepTiming& timing);

}  // namespace masked_mapper
