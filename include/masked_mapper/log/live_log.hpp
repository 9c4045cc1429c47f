// SPDX-License-Identifier: BSD-3-Clause
// A CARMEN log in text as it comes, from a pipe or a file that grows. What a first look must settle
// (the limit of the ranges, the scanner's place) is settled by the first scans, which wait for it;
// what only all of a log can tell (its wheels, its sweep) is not known yet.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "masked_mapper/log/log_reader.hpp"

namespace masked_mapper {

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

}  // namespace masked_mapper
