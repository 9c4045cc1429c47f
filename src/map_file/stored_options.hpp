// SPDX-License-Identifier: BSD-3-Clause
// The options that a map says it was made with, held against those that this program has. Options
// come and go from one program to the next, the map stays: what is not understood is said, no more.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "masked_mapper/options/options.hpp"

namespace masked_mapper {

class StoredOptions {
 public:
  StoredOptions();

  void Add(std::string key, const std::string& value);

  /// The options, with defaults in place of what is unknown or cannot be any more; what that is, a
  /// line each, is appended to `left_aside`.
  Options Take(std::vector<std::string>& left_aside);

 private:
  Options options_;
  std::set<std::string> known_;
  std::vector<std::string> unknown_;
  std::vector<std::string> refused_;
};

}  // namespace masked_mapper
