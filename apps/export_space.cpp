// SPDX-License-Identifier: BSD-3-Clause
#include "export_space.hpp"

#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "aside_folder.hpp"
#include "interrupt.hpp"
#include "masked_mapper/log/cloud_source.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "progress_bar.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

SpaceFormat SpaceFormatNamed(const std::string& name) {
  if (name == "pcd") return SpaceFormat::kPcd;
  if (name == "ply") return SpaceFormat::kPly;
  if (name == "las") return SpaceFormat::kLas;
  throw InputError("export: --clouds is for pcd, ply and las, not for `" + name + "`");
}

}  // namespace

void CheckSpaceRequest(const SpaceRequest& request) {
  SpaceFormatNamed(request.format);
  const fs::path file = fs::absolute(request.file);
  if (!file.has_filename()) throw InputError(request.file + ": not the name of a file");
  if (fs::exists(file) && !fs::is_regular_file(file)) {
    throw InputError(request.file + " exists and is not a file");
  }
}

int ExportSpace(const SavedMap& map, SpaceRequest request) {
  request.options.max_range_m = map.origin.options.grid.max_usable_range_m;
  CloudSource source(request.logs, map.origin.options.mapping.log);
  SpaceExport space(map.result, request.options);
  CatchInterrupts();
  ProgressBar progress(request.quiet);
  progress.Stage("placing clouds");
  while (const std::optional<LevelledCloud> cloud = source.Next()) {
    space.Add(*cloud);
    progress.Progress(source.Progress(), 0);
  }
  progress.Finish();
  if (space.clouds() == 0) {
    throw InputError(request.logs.front() + ": none of its clouds is of this map (" +
                     std::to_string(space.unknown()) + " have other stamps)");
  }
  const fs::path file = fs::absolute(request.file);
  const AsideFolder aside(file);
  const fs::path part = aside.path() / file.filename();
  space.Write(SpaceFormatNamed(request.format), part);
  fs::rename(part, file);
  if (!request.quiet) {
    std::cout << request.format << ": " << request.file << " (" << space.clouds() << " clouds)\n";
  }
  return 0;
}

}  // namespace masked_mapper
