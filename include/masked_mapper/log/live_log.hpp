// SPDX-License-Identifier: BSD-3-Clause
// A log as a stream: from a pipe, or a file that grows.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "masked_mapper/log/log_reader.hpp"

namespace masked_mapper {

/// A CARMEN log in text as it comes. What a first look must settle (the limit of the ranges, the
/// scanner's place) is settled by the first scans, which wait for it; what only all of a log can
/// tell (its wheels, its sweep) is not known yet.
class LiveLog {
 public:
  explicit LiveLog(const LogOptions& options);
  ~LiveLog();

  /// Bytes as they come; lines may be cut anywhere.
  void Add(std::string_view bytes);
  /// No more will come. Half a line at the end is left out, and the log counts as cut off.
  void Finish();

  /// The next observation that is ready, in order of stamps.
  std::optional<Observation> Next();
  /// So far.
  LogStatistics Statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether the first bytes of a log may be text; else it is packed, or a bag.
bool BeginsAsText(std::string_view bytes);

/// A stream that can be read but once (a pipe, standard input), kept in a temporary file so that it
/// can be read again. The file has no name any more once it is open: whatever ends the program, it
/// leaves nothing behind.
class Spool {
 public:
  /// Whether a path is such a stream.
  static bool IsStream(const std::string& path);

  /// Nothing is kept yet; `name` is the stream's, as its user knows it. Throws InputError when
  /// there is no room for temporary files.
  explicit Spool(std::string name);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// Behind what is kept so far. Throws InputError: no room for it.
  void Add(std::string_view bytes);
  /// Adds the stream at `path`, to its end. Throws InputError: cannot be opened, no room for it.
  void AddAllOf(const std::string& path);

  const std::string& name() const { return name_; }
  /// Opens the kept bytes from their beginning, as often as need be, as long as this lives.
  const std::string& path() const { return path_; }

 private:
  std::string name_;
  int file_ = -1;
  std::string path_;
};

}  // namespace masked_mapper
