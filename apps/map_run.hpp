// SPDX-License-Identifier: BSD-3-Clause
// What `map` does: from logs to the folder of a map.
#pragma once

#include <string>
#include <vector>

#include "option_flags.hpp"

namespace masked_mapper {

struct MapArguments {
  std::vector<std::string> logs;
  std::string follow;    ///< a log that grows; empty: none
  double every_s = 0.0;  ///< between two maps so far; 0: none unasked
  std::string out;
  std::string mask = "openings";
  OptionFlags options;
  std::string edits;
  std::vector<std::string> floors;
  std::string onto;
  bool forget = false;
  std::string threads;
  double checkpoint_s = 1.0;
  bool resume = false;
  bool force = false;
  bool quiet = false;
};

/// The exit code of a run that did not throw.
int RunMap(const MapArguments& asked);

}  // namespace masked_mapper
