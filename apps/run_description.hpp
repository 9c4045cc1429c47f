// SPDX-License-Identifier: BSD-3-Clause
// What a map's summary says of its making.
#pragma once

#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/options/option_table.hpp"

namespace masked_mapper {

/// The log is the first one: of a map that was grown, the one that it began with.
inline RunDescription DescriptionOf(const MapOrigin& origin, const BuildingMap& result) {
  const bool is_grown = result.drives.size() > 1;
  return {is_grown ? result.drives.front().log : origin.log, origin.mask,
          OptionValues(origin.options)};
}

}  // namespace masked_mapper
