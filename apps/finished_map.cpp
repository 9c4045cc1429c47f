// SPDX-License-Identifier: BSD-3-Clause
#include "finished_map.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "interrupt.hpp"
#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "run_description.hpp"

namespace masked_mapper {
namespace {

/// The options of drawing, as text.
NamedValues DrawingOf(const MapOrigin& origin) {
  Options options = origin.options;
  NamedValues drawing;
  for (const OptionEntry& entry : OptionTable(options)) {
    if (IsOfDrawing(entry.key)) drawing.emplace_back(entry.key, ValueText(entry));
  }
  return drawing;
}

std::string HowToGoOn(const std::string& out, ExportAdvice advice, bool too_large) {
  const std::string coarser = too_large ? " --set grid.resolution_m=COARSER" : "";
  const std::string by_export =
      "`masked_mapper export " + out + " --format all -o NEW" + coarser + "`";
  if (advice == ExportAdvice::kExport) return by_export + " writes them";
  return "the same command with --resume" + coarser + ", or " + by_export + ", writes them";
}

}  // namespace

void KeepMap(const MapOrigin& origin, BuildingMap& result, const std::string& out,
             ExistingFolder existing) {
  double seconds = 0.0;
  {
    const StageTimer timer(seconds);
    OutputFolder folder(out, existing);
    WriteMapFile(origin, result, folder.path() / kMapFileName);
    ThrowIfInterrupted();
    folder.Commit();
  }
  result.seconds.export_ += seconds;
  result.seconds.total += seconds;
}

bool IsDrawnSo(const MapOrigin& before, const MapOrigin& now) {
  return DrawingOf(before) == DrawingOf(now);
}

bool IsComplete(const BuildingMap& result, const std::string& out) {
  const std::vector<std::filesystem::path> files = ExportedFiles(result);
  return std::all_of(files.begin(), files.end(), [&](const std::filesystem::path& file) {
    return std::filesystem::exists(out / file);
  });
}

Summary ExportMap(const SavedMap& map, const std::string& out, MapFileNow map_file,
                  ExportAdvice advice) {
  const auto failed = [&](const std::string& what, bool too_large) {
    return std::runtime_error(what + "; the map itself is kept in " + out + ": " +
                              HowToGoOn(out, advice, too_large));
  };
  const bool was_complete = IsComplete(map.result, out);
  try {
    const Options& options = map.origin.options;
    OutputFolder folder(out, ExistingFolder::kComplete);
    if (map_file == MapFileNow::kNew) {
      WriteMapFile(map.origin, map.result, folder.path() / kMapFileName);
    }
    const ExportOptions export_options{options.grid, options.octree};
    Summary summary;
    try {
      summary = WriteMap(map.result, DescriptionOf(map.origin, map.result), export_options,
                         folder.path());
    } catch (const ExportError&) {
      if (!was_complete) folder.Commit();
      throw;
    }
    ThrowIfInterrupted();
    folder.Commit();
    return summary;
  } catch (const ExportError& error) {
    throw failed(error.what(), error.is_too_large);
  } catch (const Interrupted&) {
    throw failed("interrupted", false);
  } catch (const std::bad_alloc&) {
    throw failed("out of memory", false);
  } catch (const std::exception& error) {
    throw failed(error.what(), false);
  }
}

}  // namespace masked_mapper
