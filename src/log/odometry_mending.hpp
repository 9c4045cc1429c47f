// SPDX-License-Identifier: BSD-3-Clause
// A log whose wheels lie, read as if they did not: what a survey found out of them is put right
// before anybody else reads it.
#pragma once

#include <memory>
#include <vector>

#include "masked_mapper/log/log_source.hpp"

namespace masked_mapper {

/// The same log mended. Scans keep their `log_stamp`; where wheels are left out they come without
/// odometry, and so does nothing else of the wheels. Where turns are left out, the wheels' path
/// goes straight on along x. In order of the new stamps.
std::unique_ptr<LogReader> Mended(std::unique_ptr<LogReader> log, OdometryMending mending);

}  // namespace masked_mapper
