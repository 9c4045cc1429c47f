// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/map_log.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <thread>

#include "masked_mapper/log/input_error.hpp"
#include "masked_mapper/mapping/log_survey.hpp"
#include "masked_mapper/mapping/masked_mapper.hpp"
#include "masked_mapper/mapping/stage_timer.hpp"

namespace masked_mapper {
namespace {

int ThreadCount(int requested) {
  if (requested > 0) return requested;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// What was skipped or mended, said once.
void WarnOfTheLog(const std::string& path, const LogStatistics& log, MappingResult& result) {
  const auto warn = [&](const std::string& text) { result.warnings.push_back(path + ": " + text); };
  if (log.bad_lines > 0) {
    warn(std::to_string(log.bad_lines) + " bad lines skipped, the first: " + log.first_bad_line);
  }
  if (log.truncated) warn("the file is cut off; what came before the cut was used");
  if (log.stamp_jumps > 0) {
    warn(std::to_string(log.stamp_jumps) + " stamps that step backwards or wrap were mended");
  }
  if (log.empty_scans > 0) {
    warn(std::to_string(log.empty_scans) + " scans without a single return");
  }
}

}  // namespace

MappingResult MapLog(const std::string& path, const std::string& mask, const Options& options,
                     ProgressSink& progress) {
  Options settled = options;
  settled.matcher.threads = ThreadCount(options.threads);
  double total_seconds = 0.0;
  std::optional<StageTimer> total_timer(std::in_place, total_seconds);
  double survey_seconds = 0.0;
  LogSurvey survey;
  {
    const StageTimer timer(survey_seconds);
    progress.Stage("reading");
    survey = SurveyLog(path, options);
    settled.motion.source = SettleMotionSource(path, options.motion.source, survey);
  }
  MaskedMapper mapper(mask, settled, survey.floors);

  progress.Stage("mapping");
  const std::unique_ptr<LogReader> log = OpenLog(path, options.log);
  double read_seconds = survey_seconds;
  std::uint64_t scans = 0;
  while (true) {
    std::optional<Observation> observation;
    {
      const StageTimer timer(read_seconds);
      observation = log->Next();
    }
    if (!observation) break;
    mapper.Observe(*observation);
    if (std::holds_alternative<LaserScan>(*observation)) {
      progress.Progress(log->Progress(), ++scans);
    }
  }
  MappingResult result = mapper.Finish();
  result.log = log->Statistics();
  result.seconds.read = read_seconds;
  result.motion_source = settled.motion.source;
  for (const std::string& warning : survey.warnings) {
    result.warnings.push_back(path + ": " + warning);
  }
  WarnOfTheLog(path, result.log, result);
  for (const std::string& warning : result.warnings) progress.Warn(warning);
  total_timer.reset();
  result.seconds.total = total_seconds;
  return result;
}

}  // namespace masked_mapper
