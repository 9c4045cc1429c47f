// SPDX-License-Identifier: BSD-3-Clause
// What of a bag is other than its messages claim, and what was made of it: sentences for people.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bag_plan.hpp"
#include "clock_evidence.hpp"
#include "masked_mapper/sensor/sensor_finding.hpp"
#include "scanner_evidence.hpp"

namespace masked_mapper {

class BagFindings {
 public:
  /// `first` and `last`: s, of recording, of the bag. The plan must outlive this.
  BagFindings(const BagPlan& plan, double first, double last);

  void AddClock(std::size_t stream, const ClockEvidence& clock);
  /// `frame` is read, of all `frames` that the scanner's topic holds.
  void AddScanner(std::size_t scanner, const std::string& frame,
                  const std::map<std::string, ScannerEvidence>& frames);

  std::vector<SensorFinding> Take() { return std::move(findings_); }

 private:
  void Add(const std::string& what, double value, const std::string& consequence);
  void AddRanges(const std::string& topic, const ScannerRanges& ranges,
                 const ScannerEvidence& evidence);

  const BagPlan& plan_;
  double first_;  ///< s, by the clock that stamps the log
  double last_;
  std::vector<SensorFinding> findings_;
};

}  // namespace masked_mapper
