// SPDX-License-Identifier: BSD-3-Clause
// A log that is still being written, on standard input or in a file that grows: its bytes as they
// come, and all of them once more when it is over.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "progress_bar.hpp"

namespace masked_mapper {

class LiveInput {
 public:
  /// `-` is standard input, which is over when its writer closes it, and is kept in a temporary
  /// file; a file is over with Ctrl-C. Throws InputError.
  explicit LiveInput(const std::string& path);
  ~LiveInput();
  LiveInput(const LiveInput&) = delete;
  LiveInput& operator=(const LiveInput&) = delete;

  /// Until it is over, or Ctrl-C; says when nothing comes for long. Throws InputError when the file
  /// gets shorter.
  void Listen(const std::function<void(std::string_view)>& on_bytes, ProgressBar& progress);

  /// Where all that came can be read.
  const std::string& kept() const { return kept_; }

 private:
  bool IsFollowed() const { return kept_file_ < 0; }
  void Keep(std::string_view bytes) const;
  void CheckLength(std::uint64_t read) const;

  std::string path_;
  std::string kept_;
  int file_ = -1;
  int kept_file_ = -1;  ///< -1: a file keeps itself
};

}  // namespace masked_mapper
