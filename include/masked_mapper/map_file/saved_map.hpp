// SPDX-License-Identifier: BSD-3-Clause
// A map as it is kept: what was asked for, and what came of it.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/options/options.hpp"

namespace masked_mapper {

/// What a map was made from.
struct MapOrigin {
  std::string log;   ///< path as given
  std::string mask;  ///< expression as given
  Options options;   ///< as given; the number of threads is not kept

  /// Of several logs: those after the first.
  struct LaterLog {
    std::string log;     ///< path as given
    std::string floors;  ///< its file of floor labels; empty: none
  };
  std::vector<LaterLog> later_logs = {};
  std::string onto = {};      ///< the map that the logs were to join, path as given; empty: none
  std::string identity = {};  ///< of a map in the making: what tells whether its logs have changed
};

struct SavedMap {
  MapOrigin origin;
  MappingResult result;  ///< without its seconds, in which two runs differ
};

}  // namespace masked_mapper
