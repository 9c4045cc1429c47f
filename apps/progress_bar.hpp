// SPDX-License-Identifier: BSD-3-Clause
// Progress on standard error: a bar with rate and time left on a terminal, plain lines otherwise.
#pragma once

#include <chrono>
#include <string>

#include "masked_mapper/map/progress_sink.hpp"

namespace masked_mapper {

class ProgressBar : public ProgressSink {
 public:
  /// A quiet one prints nothing; it still notices interrupts.
  explicit ProgressBar(bool quiet);
  ~ProgressBar() override;

  void Stage(const std::string& name) override;
  /// Throws Interrupted after Ctrl-C.
  void Progress(double fraction, std::uint64_t scans) override;
  void Warn(const std::string& message) override;
  /// One line that is no warning.
  void Say(const std::string& message) { PrintLine(message); }
  /// The last stage is over.
  void Finish();

 private:
  using Clock = std::chrono::steady_clock;

  double SecondsSince(Clock::time_point start) const;
  std::string Rate(double seconds) const;
  void DrawBar(double seconds);
  void PrintLine(const std::string& line);

  bool quiet_;
  bool is_terminal_;
  bool bar_is_drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_;
  Clock::time_point last_shown_;
  double fraction_ = 0.0;
  double fraction_shown_ = 0.0;
  std::uint64_t scans_ = 0;
};

}  // namespace masked_mapper
