// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_source.hpp"

#include <utility>

#include "carmen_reader.hpp"
#include "log_plan.hpp"
#include "masked_mapper/log/live_log.hpp"
#include "masked_mapper/log/sqlite_file.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "odometry_mending.hpp"
#include "open_bag.hpp"
#include "rosbag_reader.hpp"

namespace masked_mapper {
namespace {

std::unique_ptr<LogPlan> PlanOf(const std::string& path, const LogOptions& options) {
  if (IsBag(path)) return PlanRosBag({path}, options);
  return PlanCarmenLog(path, options);
}

std::unique_ptr<LogPlan> PlanOfStream(const Spool& stream, const LogOptions& options) {
  try {
    if (BeginsAsSqlite(stream.path())) {
      throw InputError(stream.name() +
                       ": a ROS 2 bag in SQLite cannot be read from a stream; give its file");
    }
    return PlanOf(stream.path(), options);
  } catch (const InputError& error) {
    // The user knows the stream by the name that was given.
    std::string text = error.what();
    const std::size_t at = text.find(stream.path());
    if (at != std::string::npos) text.replace(at, stream.path().size(), stream.name());
    throw InputError(text);
  }
}

/// A pass through a stream, which keeps the stream.
class SpooledReader final : public LogReader {
 public:
  SpooledReader(std::shared_ptr<Spool> spool, std::unique_ptr<LogReader> reader)
      : spool_(std::move(spool)), reader_(std::move(reader)) {}
  std::optional<Observation> Next() override { return reader_->Next(); }
  const LogStatistics& Statistics() const override { return reader_->Statistics(); }
  double Progress() const override { return reader_->Progress(); }

 private:
  std::shared_ptr<Spool> spool_;
  std::unique_ptr<LogReader> reader_;
};

}  // namespace

LogSource::LogSource(const std::string& path, const LogOptions& options) : path_(path) {
  const std::string file = path == "-" ? "/dev/stdin" : path;
  if (Spool::IsStream(file)) {
    spool_ = std::make_shared<Spool>(path);
    spool_->AddAllOf(file);
    plan_ = PlanOfStream(*spool_, options);
  } else {
    plan_ = PlanOf(file, options);
  }
}

LogSource::LogSource(std::shared_ptr<Spool> stream, const LogOptions& options)
    : path_(stream->name()), spool_(std::move(stream)), plan_(PlanOfStream(*spool_, options)) {}

LogSource::LogSource(const std::vector<std::string>& paths, const LogOptions& options)
    : path_(paths.front()), plan_(PlanRosBag(paths, options)) {}

LogSource::~LogSource() = default;

std::unique_ptr<LogReader> LogSource::Read() const {
  std::unique_ptr<LogReader> reader = Mended(plan_->Read(), mending_);
  if (!spool_) return reader;
  return std::make_unique<SpooledReader>(spool_, std::move(reader));
}

bool LogSource::Reconsider() { return plan_->Reconsider(); }

void LogSource::KeepClouds() { plan_->KeepClouds(); }

std::vector<StampedCloud> LogSource::KeptClouds() const { return plan_->KeptClouds(); }

std::vector<SensorFinding> LogSource::Findings() const { return plan_->Findings(); }

}  // namespace masked_mapper
