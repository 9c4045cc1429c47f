// SPDX-License-Identifier: BSD-3-Clause
// Observations as the topics of a bag: /scan, /odom, /tf, /tf_static, /pressure and /imu. A bag has
// no word for the floor that a robot is on, and none for a comment.
#pragma once

#include <memory>

#include "bag_writer.hpp"
#include "log_sink.hpp"

namespace masked_mapper {

/// Throws InputError when it is given a floor's label.
std::unique_ptr<LogSink> MakeRosLogWriter(std::unique_ptr<BagWriter> bag);

}  // namespace masked_mapper
