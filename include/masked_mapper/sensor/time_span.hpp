// SPDX-License-Identifier: BSD-3-Clause
// A stretch of a log's time.
#pragma once

namespace masked_mapper {

struct TimeSpan {
  double start = 0.0;  ///< s; minus infinity: from before the log
  double end = 0.0;    ///< s; plus infinity: past the end of the log

  double Duration() const { return end - start; }
  bool Contains(double stamp) const { return start <= stamp && stamp <= end; }
};

}  // namespace masked_mapper
