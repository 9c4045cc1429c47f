// SPDX-License-Identifier: BSD-3-Clause
#include "live_input.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "interrupt.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr int kLookEveryMs = 100;
constexpr int kStalledMs = 10'000;

/// Gone with the program, whatever ends it.
int OpenNameless() {
  std::string name = (std::filesystem::temp_directory_path() / "masked_mapper-XXXXXX").string();
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

}  // namespace

LiveInput::LiveInput(const std::string& path) : path_(path), kept_(path) {
  const bool is_stdin = path == "-";
  file_ = ::open(is_stdin ? "/dev/stdin" : path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) throw InputError(path + ": " + std::strerror(errno));
  struct stat status {};
  if (!is_stdin && (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode))) {
    ::close(file_);
    throw InputError(path + ": is no file that grows; a pipe is read with `-`");
  }
  if (!is_stdin) return;
  kept_file_ = OpenNameless();
  if (kept_file_ < 0) {
    ::close(file_);
    throw InputError("-: is kept in a temporary file, which cannot be made: " +
                     std::string(std::strerror(errno)));
  }
  kept_ = "/proc/self/fd/" + std::to_string(kept_file_);
}

LiveInput::~LiveInput() {
  ::close(file_);
  if (kept_file_ >= 0) ::close(kept_file_);
}

void LiveInput::Keep(std::string_view bytes) const {
  while (kept_file_ >= 0 && !bytes.empty()) {
    const ssize_t written = ::write(kept_file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw InputError("-: is kept in a temporary file, which failed: " +
                       std::string(std::strerror(errno)));
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void LiveInput::CheckLength(std::uint64_t read) const {
  struct stat status {};
  if (::fstat(file_, &status) == 0 && static_cast<std::uint64_t>(status.st_size) < read) {
    throw InputError(path_ + ": got shorter while it was followed");
  }
}

void LiveInput::Listen(const std::function<void(std::string_view)>& on_bytes,
                       ProgressBar& progress) {
  std::vector<char> block(std::size_t{1} << 16U);
  int silent_ms = 0;
  std::uint64_t read = 0;
  bool is_told_to_end = false;
  while (true) {
    is_told_to_end |= TakeInterrupt();
    if (is_told_to_end && !IsFollowed()) return;
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
      Keep(bytes);
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
