// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/options.hpp"

#include <algorithm>
#include <thread>

namespace masked_mapper {

void SettleThreads(Options& options) {
  if (options.threads == 0) {
    options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }
  options.mapping.threads = options.threads;
  options.mapping.closures.matcher.threads = options.threads;
  options.grid.threads = options.threads;
}

}  // namespace masked_mapper
