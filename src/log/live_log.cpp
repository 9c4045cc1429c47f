// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/live_log.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "carmen_lines.hpp"
#include "line_splitter.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kMostScans = 100;  // that wait for the first look to be settled

}  // namespace

class LiveLog::Impl {
 public:
  explicit Impl(const LogOptions& options) : options_(options), finder_(options) {}

  void Add(std::string_view bytes) {
    splitter_.Add(bytes, [this](const char* begin, const char* end, bool too_long) {
      AddLine(begin, end, too_long);
    });
  }

  void Finish() {
    bool last_line_good = true;
    const bool is_half = splitter_.Finish([&](const char* begin, const char* end, bool too_long) {
      last_line_good = AddLine(begin, end, too_long);
    });
    if (!lines_) last_line_good = Settle();
    if (is_half && !last_line_good) lines_->SetTruncated();
    lines_->Finish();
  }

  std::optional<Observation> Next() { return lines_ ? lines_->Next() : std::nullopt; }
  LogStatistics Statistics() const { return lines_ ? lines_->Statistics() : LogStatistics(); }

 private:
  /// False when the line was malformed, as far as it is known yet.
  bool AddLine(const char* begin, const char* end, bool too_long) {
    if (lines_) return lines_->Add(begin, end, too_long);
    waiting_.emplace_back(begin, end);
    too_long_.push_back(too_long);
    if (too_long) return false;
    const CarmenLine line = ParseCarmenLine(begin, end, true);
    if (const auto* param = std::get_if<CarmenParam>(&line)) finder_.Add(*param);
    if (const auto* scan = std::get_if<CarmenScan>(&line)) {
      finder_.Add(*scan);
      ++scans_;
    }
    if (scans_ > 0 && (finder_.IsSettled() || scans_ >= kMostScans)) return Settle();
    return true;
  }

  bool Settle() {
    calibration_.emplace(finder_.Find());
    lines_.emplace(options_, *calibration_, false);
    bool is_good = true;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      std::string& line = waiting_[i];
      line.push_back('\n');
      is_good = lines_->Add(line.data(), line.data() + line.size() - 1, too_long_[i]);
    }
    waiting_.clear();
    return is_good;
  }

  LogOptions options_;
  LineSplitter splitter_;
  CalibrationFinder finder_;
  std::vector<std::string> waiting_;
  std::vector<bool> too_long_;
  std::size_t scans_ = 0;
  std::optional<ScanCalibration> calibration_;
  std::optional<CarmenLines> lines_;  ///< once the first look is settled
};

LiveLog::LiveLog(const LogOptions& options) : impl_(std::make_unique<Impl>(options)) {}
LiveLog::~LiveLog() = default;
void LiveLog::Add(std::string_view bytes) { impl_->Add(bytes); }
void LiveLog::Finish() { impl_->Finish(); }
std::optional<Observation> LiveLog::Next() { return impl_->Next(); }
LogStatistics LiveLog::Statistics() const { return impl_->Statistics(); }

bool BeginsAsText(std::string_view bytes) {
  constexpr std::size_t kLookedAt = 4096;
  const std::string_view first = bytes.substr(0, kLookedAt);
  return std::none_of(first.begin(), first.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x09 || byte == 0x7f || byte >= 0xf8;
  });
}

}  // namespace masked_mapper
