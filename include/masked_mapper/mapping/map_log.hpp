// SPDX-License-Identifier: BSD-3-Clause
// From a log on disk to a map in memory.
#pragma once

#include <string>

#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map/progress_sink.hpp"
#include "masked_mapper/mapping/checkpoint.hpp"
#include "masked_mapper/mapping/mapping_options.hpp"

namespace masked_mapper {

/// Maps one log, which is read twice: to survey it and to drive through it. Throws InputError for
/// what is the user's fault: a log that cannot be read or holds no scan, a mask expression that is
/// none. With `checkpoints`, goes on from the one in store, if there is one of the same log, mask
/// and options, and keeps others on the way; also one when `progress` throws. The map is the same
/// with and without; its seconds are those of this run.
BuildingMap MapLog(LogSource& source, const std::string& mask, const MappingOptions& options,
                   ProgressSink& progress, CheckpointStore* checkpoints = nullptr);

/// The same of a log that is opened for it.
BuildingMap MapLog(const std::string& path, const std::string& mask, const MappingOptions& options,
                   ProgressSink& progress, CheckpointStore* checkpoints = nullptr);

}  // namespace masked_mapper
