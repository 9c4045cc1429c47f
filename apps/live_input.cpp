// SPDX-License-Identifier: BSD-3-Clause
#include "live_input.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "interrupt.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr int kLookEveryMs = 100;
constexpr int kStalledMs = 10'000;

}  // namespace

LiveInput::LiveInput(std::string path) : path_(std::move(path)) {
  const bool is_stdin = path_ == "-";
  if (is_stdin) stream_ = std::make_shared<Spool>(path_);
  file_ = ::open(is_stdin ? "/dev/stdin" : path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) throw InputError(path_ + ": " + std::strerror(errno));
  struct stat status {};
  if (is_stdin || (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode))) return;
  ::close(file_);
  throw InputError(path_ + ": is no file that grows; a pipe is read with `-`");
}

LiveInput::~LiveInput() { ::close(file_); }

std::unique_ptr<LogSource> LiveInput::Source(const LogOptions& options) const {
  if (stream_) return std::make_unique<LogSource>(stream_, options);
  return std::make_unique<LogSource>(path_, options);
}

void LiveInput::CheckLength(std::uint64_t read) const {
  struct stat status {};
  if (::fstat(file_, &status) == 0 && static_cast<std::uint64_t>(status.st_size) < read) {
    throw InputError(path_ + ": got shorter while it was followed");
  }
}

void LiveInput::Listen(const std::function<void(std::string_view)>& on_bytes,
                       const std::function<void()>& on_look, ProgressBar& progress) {
  progress.Stage("listening");
  progress.Say("listening to " + path_);  // from here on Ctrl-C is the end of the log
  std::vector<char> block(std::size_t{1} << 16U);
  int silent_ms = 0;
  std::uint64_t read = 0;
  bool is_told_to_end = false;
  while (true) {
    is_told_to_end |= TakeInterrupt();
    if (is_told_to_end && !IsFollowed()) return;
    on_look();
    pollfd polled{file_, POLLIN, 0};
    const int ready = ::poll(&polled, 1, kLookEveryMs);
    if (ready < 0) continue;  // a signal
    const ssize_t count = ready == 0 ? 0 : ::read(file_, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(path_ + ": " + std::strerror(errno));
    if (count > 0) {
      read += static_cast<std::uint64_t>(count);
      if (silent_ms >= kStalledMs) progress.Warn(path_ + ": goes on");
      silent_ms = 0;
      const std::string_view bytes(block.data(), static_cast<std::size_t>(count));
      if (stream_) stream_->Add(bytes);
      on_bytes(bytes);
      continue;
    }
    if (is_told_to_end || (ready > 0 && !IsFollowed())) return;
    if (ready > 0) ::usleep(1000 * kLookEveryMs);  // the end of a file is always ready
    if (IsFollowed()) CheckLength(read);
    silent_ms += kLookEveryMs;
    if (silent_ms == kStalledMs) {
      progress.Warn(path_ + ": nothing came for 10 s; waiting for more, Ctrl-C ends it");
    }
  }
}

}  // namespace masked_mapper
