// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper export OUT|MAP --format F -o FILE
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "aside_folder.hpp"
#include "commands.hpp"
#include "export_space.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/export/output_folder.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "run_description.hpp"
#include "saved_map_path.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::string map;
  std::string format;
  std::string file;
  std::string floor;
  std::string resolution;
  std::vector<std::string> settings;
  std::string edits;
  bool force = false;
  HeightBand heights;
  ClearanceOptions clearance;
  bool keep_frame = false;
  bool of_clouds = false;
  std::vector<std::string> clouds;  ///< their log; none: those that the map keeps
  double voxel_m = 0.05;
  bool keeps_passers_by = false;
  RobotHeights robot;
  double memory_mib = 1280.0;
  bool quiet = false;
};

/// The format by name. Throws InputError that names all.
ExportFormat FormatNamed(const std::string& name) {
  const std::vector<std::string>& names = ExportFormatNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<ExportFormat>(found - names.begin());
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
  throw InputError("export: --format must be one of " + all + ", nav2, rmf, all, not `" + name +
                   "`");
}

/// Of a finished map only how it is drawn can still be chosen.
void SetDrawing(const std::vector<std::string>& settings, Options& options) {
  for (const std::string& setting : settings) {
    SetOption(setting, options);  // first: a mistyped one deserves the better answer
    const std::string key = setting.substr(0, setting.find('='));
    if (!IsOfDrawing(key)) {
      throw InputError("export: " + key + " has gone into the map already; --set is of grid.* and" +
                       " octree.*");
    }
  }
  CheckOptions(options);
}

SavedMap ReadMap(const ExportArguments& arguments) {
  SavedMap map = ReadMapFile(MapFileOf(arguments.map));
  for (const std::string& line : map.left_aside) {
    if (!arguments.quiet) std::cerr << "warning: " << arguments.map << ": " << line << "\n";
  }
  SetDrawing(arguments.settings, map.origin.options);
  if (!arguments.resolution.empty()) {
    SetOption("--resolution", "grid.resolution_m", arguments.resolution, map.origin.options);
  }
  if (!arguments.edits.empty()) {
    ApplyEdits(arguments.edits, map.origin.options.mapping.closures, map.result);
  }
  return map;
}

ExportOptions OptionsOf(const SavedMap& map) {
  Options options = map.origin.options;
  SettleThreads(options);
  return {options.grid, options.octree};
}

/// A whole folder, as `map` writes it.
int ExportAll(const ExportArguments& arguments) {
  if (!arguments.floor.empty() || arguments.heights != HeightBand{}) {
    throw InputError("export: --format all is of all floors and heights");
  }
  const auto existing = arguments.force ? ExistingFolder::kReplace : ExistingFolder::kRefuse;
  CheckOutputFolder(arguments.file, existing);
  const SavedMap map = ReadMap(arguments);
  OutputFolder folder(arguments.file, existing);
  WriteMapFile(map.origin, map.result, folder.path() / kMapFileName);
  try {
    WriteMap(map.result, DescriptionOf(map.origin, map.result), OptionsOf(map), folder.path());
  } catch (const ExportError& error) {
    if (error.is_too_large) throw InputError(error.what());
    throw;
  }
  folder.Commit();
  if (!arguments.quiet) std::cout << "all: " << arguments.file << "\n";
  return 0;
}

/// A folder for others' tools.
int ExportHandover(const ExportArguments& arguments) {
  if (!arguments.floor.empty() || arguments.heights != HeightBand{}) {
    throw InputError("export: --format " + arguments.format + " is of all floors and heights");
  }
  const auto existing = arguments.force ? ExistingFolder::kComplete : ExistingFolder::kRefuse;
  CheckOutputFolder(arguments.file, existing);
  const SavedMap map = ReadMap(arguments);
  HandoverOptions options;
  options.drawing = OptionsOf(map);
  options.clearance = arguments.clearance;
  options.keep_frame = arguments.keep_frame;
  OutputFolder folder(arguments.file, existing);
  (arguments.format == "nav2" ? WriteNav2 : WriteRmf)(map.result, options, folder.path());
  folder.Commit();
  if (!arguments.quiet) std::cout << arguments.format << ": " << arguments.file << "\n";
  return 0;
}

/// What the lidar of the log saw, as the map keeps it or as the log has it.
int ExportClouds(const ExportArguments& arguments) {
  SpaceRequest request;
  request.format = arguments.format;
  request.file = arguments.file;
  request.logs = arguments.clouds;
  request.voxel_m = arguments.voxel_m;
  request.keeps_passers_by = arguments.keeps_passers_by;
  request.heights = arguments.heights;
  request.robot = arguments.robot;
  request.memory_mib = arguments.memory_mib;
  request.quiet = arguments.quiet;
  CheckSpaceRequest(request);
  const SavedMap map = ReadMap(arguments);
  if (!arguments.floor.empty()) {
    request.floor = FloorOfLabel(map.result.graph.floors(), arguments.floor);
  }
  return ExportSpace(map, request);
}

int RunExport(const ExportArguments& arguments) {
  // No other map than one of clouds has points for it.
  if (arguments.of_clouds || arguments.format == "las") return ExportClouds(arguments);
  if (arguments.format == "all") return ExportAll(arguments);
  if (arguments.format == "nav2" || arguments.format == "rmf") return ExportHandover(arguments);
  SingleExport wanted;
  wanted.format = FormatNamed(arguments.format);
  wanted.heights = arguments.heights;
  const fs::path file = FileToWrite(arguments.file);
  const SavedMap map = ReadMap(arguments);
  if (!arguments.floor.empty()) {
    wanted.floor = FloorOfLabel(map.result.graph.floors(), arguments.floor);
  }
  const ExportOptions options = OptionsOf(map);
  const AsideFolder aside(file);
  std::string written;
  for (const fs::path& part :
       WriteSingleExport(map.result, options, wanted, aside.path() / file.filename())) {
    fs::rename(part, file.parent_path() / part.filename());
    const fs::path name = fs::path(arguments.file).parent_path() / part.filename();
    written += (written.empty() ? "" : ", ") + name.string();
  }
  if (!arguments.quiet) std::cout << arguments.format << ": " << written << "\n";
  return 0;
}

void AddFlags(CLI::App* command, ExportArguments* arguments) {
  command->add_option("OUT", arguments->map, "what `map` wrote, or the building.mmap in it")
      ->required()
      ->type_name("OUT|MAP");
  command
      ->add_option(
          "--format", arguments->format,
          "octomap, pcd, ply, las, grid, tum, g2o, geojson or svg; all, nav2, rmf: a folder")
      ->required()
      ->type_name("F");
  command->add_option("-o,--output", arguments->file, "the file to write; one there is replaced")
      ->required()
      ->type_name("FILE");
  command->add_option("--floor", arguments->floor, "this floor only")->type_name("LABEL");
  command
      ->add_option("--resolution", arguments->resolution,
                   "side of a cell or voxel, m; as mapped unless given")
      ->type_name("METRES");
  command
      ->add_option("--set", arguments->settings,
                   "another grid.* or octree.* option than it was mapped with")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_option("--zmin", arguments->heights.low_m, "leave out what is lower, m")
      ->type_name("METRES");
  command->add_option("--zmax", arguments->heights.high_m, "leave out what is higher, m")
      ->type_name("METRES");
  command
      ->add_option("--edits", arguments->edits,
                   "mend the map as this file says, before it is written (docs/map_file.md)")
      ->type_name("FILE");
  command
      ->add_option("--clouds", arguments->clouds,
                   "of octomap, grid, pcd, ply and las: by what the 3D lidar saw, as the map keeps "
                   "it; with the log that was mapped (its bags in order): by all of it")
      ->expected(0, -1)
      ->type_name("[LOG]");
  command->add_option("--voxel", arguments->voxel_m, "of --clouds: one point per so much, m")
      ->check(CLI::Range(0.005, 10.0))
      ->capture_default_str()
      ->type_name("METRES");
  command->add_flag("--keep-passers-by", arguments->keeps_passers_by,
                    "of pcd, ply and las with --clouds: also points where rays passed later or "
                    "before, which is faster");
  command
      ->add_option("--robot-height", arguments->robot.high_m,
                   "of a grid with --clouds: what hangs higher the robot passes below, m")
      ->check(CLI::Range(0.2, 100.0))
      ->capture_default_str()
      ->type_name("METRES");
  command
      ->add_option("--memory", arguments->memory_mib,
                   "of --clouds: voxels for rays at the most, MiB; the log is read again for "
                   "floors that do not fit")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str()
      ->type_name("MIB");
  command
      ->add_option("--radius", arguments->clearance.radius_m,
                   "of nav2 and rmf: of the robot for which there must be room, m")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str()
      ->type_name("METRES");
  command->add_flag("--keep-frame", arguments->keep_frame,
                    "of nav2 and rmf: do not turn the map so that its walls are square");
  command->add_flag("--force", arguments->force,
                    "of a folder: replace the map in FILE, or what nav2 and rmf wrote there");
  command->add_flag("--quiet", arguments->quiet, "print errors only");
}

constexpr const char* kFooter =
    "Formats: octomap (.bt), pcd and ply (walls, coloured per floor), grid (.pgm and .yaml as\n"
    "map_server has them, of one floor), las (LAS 1.4, of clouds alone), tum (the pose of\n"
    "every scan), g2o (the pose graph);\n"
    "geojson and svg: floor plans of lines, in metres of the map, one layer per floor.\n"
    "all: everything that `map` writes, into a folder. nav2 and rmf: folders that Nav2 "
    "(map_server,\n"
    "keep-out filter, route server) and Open-RMF (traffic editor, fleet adapters) open as they "
    "are;\n"
    "their frame.yaml says how the map was turned.\n"
    "With nothing else asked for, the bytes are those that `map` wrote.\n\n"
    "Examples:\n"
    "  masked_mapper export out --format octomap -o coarse.bt --resolution 0.2\n"
    "  masked_mapper export out/building.mmap --format grid --floor 2 -o second_floor.pgm\n"
    "  masked_mapper export out --format svg -o plans.svg\n"
    "  masked_mapper export out --format nav2 -o for_the_robot\n"
    "  masked_mapper export out --format all --edits edits.yaml -o mended\n"
    "  masked_mapper export out --format las -o building.las\n"
    "  masked_mapper export out --format octomap --clouds -o space.bt\n"
    "  masked_mapper export out --format pcd --clouds drive.mcap --voxel 0.02 -o fine.pcd\n"
    "  masked_mapper export out --format pcd --zmin -0.5 --zmax 3 -o ground.pcd";

}  // namespace

void AddExportCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      program.add_subcommand("export", "Write a map in one format, from the saved map alone");
  AddFlags(command, arguments.get());
  command->footer(kFooter);
  command->callback([arguments, command, &run] {
    // Without a log the parser leaves an empty one.
    arguments->of_clouds = command->count("--clouds") > 0;
    std::vector<std::string>& logs = arguments->clouds;
    logs.erase(std::remove(logs.begin(), logs.end(), ""), logs.end());
    run = [arguments] { return RunExport(*arguments); };
  });
}

}  // namespace masked_mapper
