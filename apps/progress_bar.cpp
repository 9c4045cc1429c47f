// SPDX-License-Identifier: BSD-3-Clause
#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "interrupt.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr double kRedrawSeconds = 0.1;  // of the bar
constexpr double kLineSeconds = 2.0;    // between plain lines, at the least
constexpr double kLineFraction = 0.1;   // and the same in progress
constexpr int kBarWidth = 24;

/// "7 s", "2 min 05 s", "3 h 12 min".
std::string Duration(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::clamp(seconds, 0.0, 1e9)));
  char text[64];
  if (whole < 60) {
    std::snprintf(text, sizeof text, "%lld s", whole);
  } else if (whole < 3600) {
    std::snprintf(text, sizeof text, "%lld min %02lld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld h %02lld min", whole / 3600, whole / 60 % 60);
  }
  return text;
}

}  // namespace

ProgressBar::ProgressBar(bool quiet) : quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  // An error's line must not stand behind half a bar.
  if (bar_is_drawn_) std::fputs("\r\x1b[K", stderr);
}

double ProgressBar::SecondsSince(Clock::time_point start) const {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string ProgressBar::Rate(double seconds) const {
  if (scans_ == 0) return "";
  return FixedText(static_cast<double>(scans_) / std::max(seconds, 1e-3), 0) + " scans/s";
}

void ProgressBar::PrintLine(const std::string& line) {
  if (quiet_) return;
  if (bar_is_drawn_) std::fputs("\r\x1b[K", stderr);
  bar_is_drawn_ = false;
  std::fprintf(stderr, "%s\n", line.c_str());
}

void ProgressBar::Stage(const std::string& name) {
  Finish();
  stage_ = name;
  stage_start_ = last_shown_ = Clock::now();
  fraction_ = fraction_shown_ = 0.0;
  scans_ = 0;
}

void ProgressBar::Finish() {
  ThrowIfInterrupted();
  if (stage_.empty()) return;
  const double seconds = SecondsSince(stage_start_);
  PrintLine(stage_ + ": " + (scans_ == 0 ? "" : std::to_string(scans_) + " scans, ") +
            FixedText(seconds, 1) + " s" + (scans_ == 0 ? "" : ", " + Rate(seconds)));
  stage_.clear();
}

void ProgressBar::Progress(double fraction, std::uint64_t scans) {
  ThrowIfInterrupted();
  fraction_ = std::clamp(fraction, 0.0, 1.0);
  scans_ = scans;
  if (quiet_) return;
  const double since_shown = SecondsSince(last_shown_);
  if (is_terminal_ ? since_shown < kRedrawSeconds
                   : since_shown < kLineSeconds || fraction_ - fraction_shown_ < kLineFraction) {
    return;
  }
  last_shown_ = Clock::now();
  fraction_shown_ = fraction_;
  DrawBar(SecondsSince(stage_start_));
}

void ProgressBar::DrawBar(double seconds) {
  const std::string percent = FixedText(100.0 * fraction_, 0) + " %";
  const std::string left =
      fraction_ > 0.0 ? Duration(seconds / fraction_ * (1.0 - fraction_)) + " left" : "";
  if (!is_terminal_) {
    PrintLine(stage_ + ": " + percent + (scans_ == 0 ? "" : ", " + Rate(seconds)) + ", " + left);
    return;
  }
  const auto filled = static_cast<std::size_t>(std::lround(kBarWidth * fraction_));
  const std::string bar = std::string(filled, '=') + std::string(kBarWidth - filled, ' ');
  std::fprintf(stderr, "\r%-10s [%s] %5s  %14s  %s\x1b[K", stage_.c_str(), bar.c_str(),
               percent.c_str(), Rate(seconds).c_str(), left.c_str());
  std::fflush(stderr);
  bar_is_drawn_ = true;
}

void ProgressBar::Warn(const std::string& message) { PrintLine("warning: " + message); }

}  // namespace masked_mapper
