// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_mending.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongestSilence = 3.0;  // s; no odometry is so slow

TimeSpan Always() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {-kInfinity, kInfinity};
}

std::string SpanText(const TimeSpan& span) {
  return FixedText(span.Duration(), 1) + " s from " + FixedText(span.start, 3) + " on";
}

}  // namespace

std::string InWords(const FalseRest& rest) {
  return (rest.leap_m > 0.0
              ? "odometry leaps by " + FixedText(rest.leap_m, 2) + " m at the end of "
              : "the wheels stand still while the scene moves past the scanner, for ") +
         SpanText(rest.span);
}

// One fault hides others: with another clock wheels seem to stand still where they do not, and
// wheels that are of no use stand still in many ways. So the graver is mended alone, and asked
// again.
WheelMending MendingOf(const WheelFault& fault, const std::vector<FalseRest>& rests,
                       const TimeSpan& log) {
  WheelMending wheels;
  OdometryMending& mending = wheels.mending;
  const auto tell = [&](const std::string& what, const Estimated& estimate, const TimeSpan& span,
                        const std::string& consequence) {
    wheels.findings.push_back(
        {what, estimate.value, estimate.sigma, span.start, span.end, consequence});
  };
  if (fault.scan_clock_s) {
    mending.scan_clock_s = fault.scan_clock_s->value;
    tell("stamps of the scans are " + FixedText(std::abs(mending.scan_clock_s), 2) + " s " +
             (mending.scan_clock_s > 0.0 ? "ahead of" : "behind") + " the odometry's",
         *fault.scan_clock_s, log,
         "they are mapped with that taken off; the trajectory has the log's stamps");
    return wheels;
  }
  if (fault.travel_useless) {
    tell("the way that the odometry tells is not that which scans see", {1.0, 0.0}, log,
         "odometry is left out; scans alone tell the motion");
    mending.left_out = {Always()};
    return wheels;
  }
  if (fault.turns_useless) {
    tell("the turns that the odometry tells are not those that scans see", {1.0, 0.0}, log,
         "it is asked for the length of the way only; scans alone tell the turns");
    mending.turns_left_out = true;
    return wheels;
  }
  for (const FalseRest& rest : rests) {
    tell(InWords(rest), {rest.span.Duration(), 0.0}, rest.span,
         "scans alone tell the way meanwhile");
    mending.left_out.push_back(rest.span);
  }
  if (fault.travel_factor) {
    mending.travel_factor = fault.travel_factor->value;
    tell("true travel over that by odometry is " + FixedText(mending.travel_factor, 3),
         *fault.travel_factor, log, "the odometry's travel is multiplied by it");
  }
  if (fault.turn_factor) {
    mending.turn_factor = fault.turn_factor->value;
    tell("true turns over those by odometry are " + FixedText(mending.turn_factor, 3),
         *fault.turn_factor, log, "the odometry's turns are multiplied by it");
  }
  return wheels;
}

void Add(const WheelMending& more, WheelMending* wheels) {
  OdometryMending& mending = wheels->mending;
  mending.scan_clock_s += more.mending.scan_clock_s;
  mending.travel_factor *= more.mending.travel_factor;
  mending.turn_factor *= more.mending.turn_factor;
  mending.turns_left_out |= more.mending.turns_left_out;
  mending.left_out.insert(mending.left_out.end(), more.mending.left_out.begin(),
                          more.mending.left_out.end());
  std::sort(mending.left_out.begin(), mending.left_out.end(),
            [](const TimeSpan& a, const TimeSpan& b) { return a.start < b.start; });
  wheels->findings.insert(wheels->findings.end(), more.findings.begin(), more.findings.end());
}

void AddSilences(const std::vector<UnbrokenWay::Silence>& silences, const OdometryMending& mending,
                 std::vector<SensorFinding>* findings) {
  for (const UnbrokenWay::Silence& silence : silences) {
    const TimeSpan& span = silence.span;
    const bool is_told = std::any_of(
        mending.left_out.begin(), mending.left_out.end(), [&](const TimeSpan& left_out) {
          return left_out.start <= span.end && span.start <= left_out.end;
        });
    if (is_told || span.Duration() <= kLongestSilence) continue;
    findings->push_back({"odometry is silent for " + SpanText(span), span.Duration(), 0.0,
                         span.start, span.end,
                         "scans alone tell the way meanwhile, to about " +
                             FixedText(silence.way_sigma_m, 2) + " m"});
  }
}

}  // namespace masked_mapper
