// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/log_survey.hpp"

#include <optional>
#include <utility>

namespace masked_mapper {
namespace {

class StraightenedReader final : public LogReader {
 public:
  StraightenedReader(std::unique_ptr<LogReader> log, const SweepTiming& timing)
      : log_(std::move(log)), straightener_(timing) {}

  std::optional<Observation> Next() override {
    while (true) {
      std::optional<Observation> next = straightener_.Next();
      if (next || at_end_) return next;
      if (std::optional<Observation> read = log_->Next()) {
        straightener_.Add(std::move(*read));
      } else {
        straightener_.Finish();
        at_end_ = true;
      }
    }
  }

  const LogStatistics& Statistics() const override { return log_->Statistics(); }
  double Progress() const override { return log_->Progress(); }

 private:
  std::unique_ptr<LogReader> log_;
  SweepStraightener straightener_;
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> ReadStraightened(const LogSource& source, const SweepTiming& timing) {
  return std::make_unique<StraightenedReader>(source.Read(), timing);
}

}  // namespace masked_mapper
