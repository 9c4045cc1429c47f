// SPDX-License-Identifier: BSD-3-Clause
// What the headers of one topic say of its clock, held against the times of recording. A clock is
// settled by the many: a few headers from before it was set, or of a sensor that counts from its
// power-on, change nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace masked_mapper {

struct TopicClock {
  std::optional<double> offset;  ///< s, header minus recording; empty: no header has a stamp
  bool is_steady = false;        ///< most headers agree with it
  bool whole_seconds = false;    ///< headers lack what is below a second
};

/// Topics whose headers are farther apart than this go by other clocks.
constexpr double kClocksApart = 5.0;  // s
/// A header farther from what the many of its topic say is of another clock; nearer, it may have
/// been recorded late.
constexpr double kStray = 60.0;  // s

class ClockEvidence {
 public:
  /// s; a header's stamp of 0 is none.
  void Add(double header, double recorded);
  bool IsEmpty() const { return samples_.empty(); }
  std::size_t size() const { return seen_; }

  TopicClock Find() const;

  /// Headers of another clock than the many, and when they were recorded.
  struct Strays {
    double share = 0.0;
    double first = 0.0;  ///< s, of recording
    double last = 0.0;
  };
  Strays FindStrays(const TopicClock& clock) const;

 private:
  struct Sample {
    double recorded = 0.0;
    double offset = 0.0;
  };
  double Quantile(double share) const;

  std::vector<Sample> samples_;  ///< one of `stride_`, at most kMostSamples
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  std::size_t whole_ = 0;
  double first_ = 0.0;  ///< s, the least and the greatest header
  double last_ = 0.0;
};

}  // namespace masked_mapper
