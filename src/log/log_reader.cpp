// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_reader.hpp"

#include "masked_mapper/log/carmen_reader.hpp"
#include "masked_mapper/log/open_bag.hpp"
#include "masked_mapper/log/rosbag_reader.hpp"

namespace masked_mapper {

std::unique_ptr<LogReader> OpenLog(const std::string& path, const LogOptions& options) {
  if (IsBag(path)) return OpenRosBag(path, options);
  return OpenCarmenLog(path, options);
}

}  // namespace masked_mapper
