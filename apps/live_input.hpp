// SPDX-License-Identifier: BSD-3-Clause
// A log that is still being written, on standard input or in a file that grows: its bytes as they
// come, and all of them once more when it is over.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "masked_mapper/log/live_log.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "progress_bar.hpp"

namespace masked_mapper {

class LiveInput {
 public:
  /// `-` is standard input, which is over when its writer closes it, and is kept in a temporary
  /// file; a file is over with Ctrl-C. Throws InputError.
  explicit LiveInput(std::string path);
  ~LiveInput();
  LiveInput(const LiveInput&) = delete;
  LiveInput& operator=(const LiveInput&) = delete;

  /// Until it is over, or Ctrl-C; says when nothing comes for long. `on_look` is called whenever
  /// there was a look for more, ten times a second at least unless the two themselves take longer.
  /// Throws InputError when the file gets shorter.
  void Listen(const std::function<void(std::string_view)>& on_bytes,
              const std::function<void()>& on_look, ProgressBar& progress);

  /// As it was given.
  const std::string& path() const { return path_; }
  /// Where all that came can be read.
  const std::string& kept_path() const { return stream_ ? stream_->path() : path_; }
  /// All that came, as a log.
  std::unique_ptr<LogSource> Source(const LogOptions& options) const;

 private:
  bool IsFollowed() const { return stream_ == nullptr; }
  void CheckLength(std::uint64_t read) const;

  std::string path_;
  std::shared_ptr<Spool> stream_;  ///< null: a file keeps itself
  int file_ = -1;
};

}  // namespace masked_mapper
