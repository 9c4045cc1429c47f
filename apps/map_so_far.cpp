// SPDX-License-Identifier: BSD-3-Clause
#include "map_so_far.hpp"

#include <algorithm>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "finished_map.hpp"
#include "interrupt.hpp"
#include "map_drives.hpp"
#include "masked_mapper/log/live_log.hpp"
#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

class GivenUp : public std::exception {};

/// Nobody is told how far it is; it may be given up at any scan.
class GivesUp final : public ProgressSink {
 public:
  explicit GivesUp(const std::atomic<bool>& is_given_up) : is_given_up_(is_given_up) {}
  void Stage(const std::string& /*name*/) override { Check(); }
  void Progress(double /*fraction*/, std::uint64_t /*scans*/) override { Check(); }

 private:
  void Check() const {
    if (is_given_up_) throw GivenUp();
  }

  const std::atomic<bool>& is_given_up_;
};

std::string HowFar(const BuildingMap& map) {
  return std::to_string(map.log.scans) + " scans, up to " + FixedText(map.log.last_stamp, 3) + " s";
}

}  // namespace

MapSoFar::MapSoFar(const MapArguments& arguments, const MapOrigin& origin, std::string kept_path,
                   ExistingFolder existing, ProgressBar& progress)
    : arguments_(arguments),
      origin_(origin),
      kept_path_(std::move(kept_path)),
      existing_(existing),
      progress_(progress),
      copy_(std::make_shared<Spool>(origin.log)),
      earliest_(Clock::now()) {}

bool MapSoFar::Finish() {
  is_given_up_ = true;
  Join();
  return is_there_;
}

void MapSoFar::Note(std::string_view bytes) {
  if (!is_text_ && !bytes.empty()) is_text_ = BeginsAsText(bytes);
  const std::size_t last_break = bytes.rfind('\n');
  if (last_break != std::string_view::npos) whole_lines_ = came_ + last_break + 1;
  came_ += bytes.size();
}

void MapSoFar::Look() {
  is_asked_ |= TakeRequest();
  if (worker_.joinable()) {
    if (!is_done_) return;
    Join();
    // Half of the time at most: what came meanwhile must be worth the work.
    earliest_ = Clock::now() + (Clock::now() - begun_);
  }
  if (!is_asked_ && !IsDue()) return;
  is_asked_ = false;
  Begin();
}

bool MapSoFar::IsDue() {
  if (arguments_.every_s <= 0.0 || came_ == copied_) return false;
  const auto interval = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(arguments_.every_s));
  if (begun_ == Clock::time_point()) begun_ = Clock::now();  // the first comes after the first N
  return Clock::now() >= std::max(begun_ + interval, earliest_);
}

void MapSoFar::Begin() {
  CopyWhatCame();
  begun_ = Clock::now();
  is_done_ = false;
  worker_ = std::thread([this] { Make(); });
}

// Half a line is no fault of a log that is still coming.
void MapSoFar::CopyWhatCame() {
  const std::uint64_t end = is_text_.value_or(true) ? whole_lines_ : came_;
  std::ifstream kept(kept_path_, std::ios::binary);
  kept.seekg(static_cast<std::streamoff>(copied_));
  std::vector<char> block(std::size_t{1} << 18U);
  while (kept && copied_ < end) {
    const std::uint64_t wanted = std::min<std::uint64_t>(block.size(), end - copied_);
    kept.read(block.data(), static_cast<std::streamsize>(wanted));
    copy_->Add({block.data(), static_cast<std::size_t>(kept.gcount())});
    copied_ += static_cast<std::uint64_t>(kept.gcount());
  }
}

// Runs beside the listening; says nothing itself.
void MapSoFar::Make() {
  try {
    LogSources sources;
    sources.push_back(std::make_unique<LogSource>(copy_, origin_.options.mapping.log));
    Keeping nothing{FinishedDrives(arguments_.out, origin_, false), nullptr};
    GivesUp sink(is_given_up_);
    Write(MapLogs(arguments_, origin_, sources, nothing, sink));
  } catch (const GivenUp&) {
    said_.clear();
  } catch (const Interrupted&) {
    said_.clear();
  } catch (const std::exception& error) {
    said_ = std::string("no map so far: ") + error.what();
  }
  is_done_ = true;
}

void MapSoFar::Write(BuildingMap map) {
  if (is_given_up_) throw GivenUp();
  const std::string how_far = HowFar(map);
  map.warnings.insert(map.warnings.begin(),
                      "this is the map so far, of a log that was still coming: " + how_far);
  MapOrigin origin = origin_;
  origin.so_far = how_far;
  KeepMap(origin, map, arguments_.out, is_there_ ? ExistingFolder::kReplace : existing_);
  was_written_ = true;
  said_ = "map so far: " + arguments_.out + ", " + how_far;
}

void MapSoFar::Join() {
  if (!worker_.joinable()) return;
  worker_.join();
  is_there_ |= was_written_;
  if (said_.empty()) return;
  if (was_written_) {
    progress_.Say(said_);
  } else {
    progress_.Warn(said_);
  }
  said_.clear();
  was_written_ = false;
}

}  // namespace masked_mapper
