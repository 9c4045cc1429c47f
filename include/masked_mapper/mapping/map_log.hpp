// SPDX-License-Identifier: BSD-3-Clause
// From a log on disk to a map in memory.
#pragma once

#include <string>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/progress_sink.hpp"
#include "masked_mapper/mapping/checkpoint.hpp"
#include "masked_mapper/mapping/mapping_options.hpp"

namespace masked_mapper {

/// Maps one log. Throws InputError for what is the user's fault: a log that cannot be read or holds
/// no scan, a mask expression that is none. With `checkpoints`, goes on from the one in store, if
/// there is one of the same log, mask and options, and keeps others on the way; also one when
/// `progress` throws. The map is the same with and without; its seconds are those of this run.
BuildingMap MapLog(const std::string& path, const std::string& mask, const MappingOptions& options,
                   ProgressSink& progress, CheckpointStore* checkpoints = nullptr);

}  // namespace masked_mapper
