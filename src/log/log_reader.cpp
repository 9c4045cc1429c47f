// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_reader.hpp"

#include "masked_mapper/log/log_source.hpp"

namespace masked_mapper {

std::unique_ptr<LogReader> OpenLog(const std::string& path, const LogOptions& options) {
  return LogSource(path, options).Read();
}

}  // namespace masked_mapper
