// SPDX-License-Identifier: BSD-3-Clause
#include "bag_findings.hpp"

#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kNoLidar = 20.0;  // m; every lidar on a robot sees something nearer, if but once

}  // namespace

BagFindings::BagFindings(const BagPlan& plan, double first, double last)
    : plan_(plan), first_(first + plan.clock_offset), last_(last + plan.clock_offset) {
  if (!plan.is_disordered) return;
  Add("messages of the bag that stand later than others recorded seconds after them", 1.0,
      "all are put in the order of their recording");
}

void BagFindings::Add(const std::string& what, double value, const std::string& consequence) {
  findings_.push_back({what, value, 0.0, first_, last_, consequence});
}

void BagFindings::AddClock(std::size_t stream, const ClockEvidence& clock) {
  const std::string& name = plan_.topics[stream].name;
  const TopicClock& found = plan_.clocks[stream];
  if (!found.offset || plan_.topics[stream].kind == TopicKind::kTransforms) return;
  const ClockEvidence::Strays strays = clock.FindStrays(found);
  if (std::abs(*found.offset - plan_.clock_offset) > kClocksApart) {
    Add("clock of " + name + " against that of " + plan_.topics.front().name + ", s",
        *found.offset - plan_.clock_offset, "its readings are stamped by their recording");
  } else if (found.whole_seconds) {
    Add("stamps of " + name + " in whole seconds, s", 1.0,
        "its readings are stamped by their recording");
  } else if (found.is_steady && strays.share > 0.0) {
    findings_.push_back({"share of the stamps of " + name + " by another clock", strays.share, 0.0,
                         strays.first + *found.offset, strays.last + *found.offset,
                         "those readings are stamped by their recording"});
  }
}

void BagFindings::AddScanner(std::size_t scanner, const std::string& frame,
                             const std::map<std::string, ScannerEvidence>& frames) {
  const std::string& topic = plan_.topics[scanner].name;
  if (!plan_.topics[scanner].frame.empty()) {
    std::string others;
    double left_out = 0.0;
    for (const auto& [other_frame, other] : frames) {
      if (other_frame == frame) continue;
      others += (others.empty() ? "`" : ", `") + other_frame + "`";
      left_out += static_cast<double>(other.scans());
    }
    Add("scans of other frames on " + topic, left_out,
        "those of `" + frame + "` are taken, those of " + others + " left out");
  }
  const ScannerEvidence& evidence = frames.at(frame);
  if (evidence.nearest_of_clouds() > kNoLidar && std::isfinite(evidence.nearest_of_clouds())) {
    Add("nearest return of all on " + topic + ", m", evidence.nearest_of_clouds(),
        "these clouds are not told from where the lidar is, and scans cut from them are wrong: "
        "read the topic of its driver");
  }
  AddRanges(topic, plan_.ranges[scanner], evidence);
}

void BagFindings::AddRanges(const std::string& topic, const ScannerRanges& ranges,
                            const ScannerEvidence& evidence) {
  if (ranges.scale != 1.0) {
    Add("unit of the ranges of " + topic + ", m", ranges.scale, "they are read as millimetres");
  } else if (!ranges.believes_range_min) {
    Add("range_min of " + topic + ", m", evidence.range_min(),
        "nearer ranges see surfaces all the same and are taken");
  } else if (evidence.ShareWithinLimits() < 0.01) {
    Add("share of the ranges of " + topic + " within the limits that it states",
        evidence.ShareWithinLimits(), "they cannot be read: neither as metres nor as millimetres");
  }
}

}  // namespace masked_mapper
