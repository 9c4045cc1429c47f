// SPDX-License-Identifier: BSD-3-Clause
#include "carmen_reader.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "carmen_line.hpp"
#include "carmen_lines.hpp"
#include "kept_pass.hpp"
#include "line_splitter.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "read_ahead.hpp"
#include "scan_calibration.hpp"
#include "text_ahead.hpp"
#include "text_source.hpp"
#include "unpadded_stamps.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kFirstBlock = 256 * 1024;
/// Of a pass that is kept, which where files are in memory takes memory. A longer log is read
/// again.
constexpr std::uint64_t kMostKept = std::uint64_t{512} << 20U;

/// Whether the beginning of a file could be text: no zero bytes, hardly any control characters.
bool LooksLikeText(std::string_view beginning) {
  const auto control = std::count_if(beginning.begin(), beginning.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && !(byte >= '\t' && byte <= '\r')) || byte == 0x7f;
  });
  return beginning.find('\0') == std::string_view::npos &&
         static_cast<double>(control) <= 0.05 * static_cast<double>(beginning.size());
}

/// Throws InputError when the file is no text at all.
void CheckBeginning(const std::string& path, const TextSource& source, std::string_view block) {
  constexpr std::size_t kLookedAt = 4096;
  if (block.empty() && source.IsPacked() && source.Truncated()) {
    throw InputError(path + ": begins like a packed file, but cannot be unpacked");
  }
  if (block.empty()) throw InputError(path + ": is empty");
  if (!LooksLikeText(block.substr(0, kLookedAt))) {
    throw InputError(
        path +
        ": is binary, expected a CARMEN log (text, also in gzip, bzip2 or zstd) or a bag "
        "of ROS (.bag, .db3, .mcap)");
  }
}

/// The first look: until nothing that is wanted from it would change.
ScanCalibration LookAt(const std::string& path, const LogOptions& options) {
  TextSource source(path);
  CalibrationFinder finder(options);
  LineSplitter splitter;
  std::vector<char> block(kFirstBlock);
  bool settled = false;
  const auto on_line = [&](const char* begin, const char* end, bool too_long) {
    if (settled || too_long) return;
    const CarmenLine line = ParseCarmenLine(begin, end, true);
    if (const auto* param = std::get_if<CarmenParam>(&line)) finder.Add(*param);
    if (const auto* scan = std::get_if<CarmenScan>(&line)) {
      finder.Add(*scan);
      settled = finder.IsSettled();
    }
  };
  bool is_first = true;
  while (!settled) {
    const std::size_t count = source.Read(block.data(), block.size());
    if (is_first) CheckBeginning(path, source, {block.data(), count});
    is_first = false;
    splitter.Add({block.data(), count}, on_line);
    if (count < block.size()) {
      splitter.Finish(on_line);
      break;
    }
  }
  return finder.Find();
}

/// Passes on what is ready; false when nobody wants it any more.
bool HandOver(CarmenLines* lines, double progress, const ReadAhead::Sink& sink) {
  bool more = true;
  while (more) {
    ObservationBatch batch;
    while (batch.observations.size() < ObservationBatch::kSize) {
      std::optional<Observation> observation = lines->Next();
      more = observation.has_value();
      if (!more) break;
      batch.observations.push_back(std::move(*observation));
    }
    batch.statistics = lines->Statistics();
    batch.progress = progress;
    if (!sink(std::move(batch))) return false;
  }
  return true;
}

/// What the passes to the end found, handed from their threads to the plan.
struct WholeLog {
  std::mutex mutex;
  UnpaddedStamps stamps;
  LogStatistics statistics;
};

void ReadCarmenLog(const std::string& path, const LogOptions& options,
                   const ScanCalibration& calibration, bool is_unpadded, WholeLog* whole,
                   KeptPass* kept, const ReadAhead::Sink& sink) {
  TextAhead text(path);
  CarmenLines lines(options, calibration, is_unpadded);
  LineSplitter splitter;
  bool last_line_good = true;
  const auto on_line = [&](const char* begin, const char* end, bool too_long) {
    last_line_good = lines.Add(begin, end, too_long);
  };
  while (const std::optional<TextBlock> block = text.Next()) {
    splitter.Add(block->text, on_line);
    if (block->is_last) {
      if (splitter.Finish(on_line) && !last_line_good) lines.SetTruncated();
      if (block->truncated) lines.SetTruncated();
      lines.SetTrailingBytes(block->trailing_bytes);
      lines.Finish();
    }
    if (!HandOver(&lines, block->progress, [&](ObservationBatch batch) {
          kept->Add(batch);
          return sink(std::move(batch));
        })) {
      return;
    }
  }
  kept->Finish();
  const std::lock_guard<std::mutex> lock(whole->mutex);
  whole->stamps = lines.unpadded_stamps();
  whole->statistics = lines.Statistics();
}

class CarmenPlan final : public LogPlan {
 public:
  CarmenPlan(std::string path, const LogOptions& options)
      : path_(std::move(path)), options_(options), calibration_(LookAt(path_, options)) {}

  std::unique_ptr<LogReader> Read() override {
    LogStatistics statistics;
    statistics.max_range = calibration_.max_range();
    if (kept_ && kept_->IsWhole()) {
      return std::make_unique<ReadAhead>(
          statistics, [kept = kept_](const ReadAhead::Sink& sink) { kept->Replay(sink); });
    }
    kept_ = std::make_shared<KeptPass>(kMostKept);
    return std::make_unique<ReadAhead>(
        statistics,
        [path = path_, options = options_, calibration = calibration_, is_unpadded = is_unpadded_,
         whole = whole_, kept = kept_](const ReadAhead::Sink& sink) {
          ReadCarmenLog(path, options, calibration, is_unpadded, whole.get(), kept.get(), sink);
        });
  }

  bool Reconsider() override {
    const std::lock_guard<std::mutex> lock(whole_->mutex);
    if (is_unpadded_ || !whole_->stamps.IsFound()) return false;
    is_unpadded_ = true;
    kept_.reset();
    return true;
  }

  std::vector<SensorFinding> Findings() const override {
    if (!is_unpadded_) return {};
    const std::lock_guard<std::mutex> lock(whole_->mutex);
    return {{"stamps with microseconds that lack the zeros in front",
             static_cast<double>(whole_->stamps.mended()), 0.0, whole_->statistics.first_stamp,
             whole_->statistics.last_stamp, "they are read as they are meant"}};
  }

 private:
  std::string path_;
  LogOptions options_;
  ScanCalibration calibration_;
  std::shared_ptr<WholeLog> whole_ = std::make_shared<WholeLog>();
  std::shared_ptr<KeptPass> kept_;  ///< of the last pass
  bool is_unpadded_ = false;
};

}  // namespace

std::unique_ptr<LogPlan> PlanCarmenLog(const std::string& path, const LogOptions& options) {
  return std::make_unique<CarmenPlan>(path, options);
}

}  // namespace masked_mapper
