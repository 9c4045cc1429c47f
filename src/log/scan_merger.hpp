// SPDX-License-Identifier: BSD-3-Clause
// Several scanners on one robot as one. Each scan of the first is joined by the scans of the others
// that were taken nearest to it, moved along by odometry, and all hits are seen again from the
// robot's origin: a virtual scanner that looks all round, with the finest step of them all. Where
// several hits fall into one beam, the nearest counts; a beam is "no return" only where a scanner
// looked and nothing was hit; where none looked it is invalid. This is our choice: everything
// behind the reader knows one scanner per robot.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

class ScanMerger {
 public:
  explicit ScanMerger(std::size_t scanners) : latest_(scanners) {}

  /// Scans of all scanners in order of stamps; `scanner` 0 sets the pace.
  void Add(LaserScan scan, std::size_t scanner);
  void Finish() { finished_ = true; }
  /// The next virtual scan, at the stamp and the odometry of the first scanner's.
  std::optional<LaserScan> Next();

 private:
  bool IsComplete() const;

  std::vector<std::deque<LaserScan>> latest_;  ///< per scanner, those that may still be joined
  double newest_ = 0.0;                        ///< s
  bool finished_ = false;
};

/// One virtual scan about the robot's origin; the first scan gives stamp and odometry.
LaserScan MergeScans(const std::vector<const LaserScan*>& scans);

}  // namespace masked_mapper
