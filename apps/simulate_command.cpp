// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper simulate --building NAME|FILE -o LOG
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "interrupt.hpp"
#include "masked_mapper/simulation/building.hpp"
#include "masked_mapper/simulation/simulation.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "progress_bar.hpp"

namespace masked_mapper {
namespace {

struct SimulateArguments {
  std::string building;
  std::string log;
  std::uint64_t seed = 1;
  std::uint64_t tour = 1;
  double length_m = 0.0;
  std::vector<std::string> visits;
  std::string lidar = "2d";
  double lidar_rate_hz = 0.0;
  bool perfect = false;
  bool floor_labels = false;
  bool without_pressure = false;
  bool with_imu = false;
  bool force = false;
  bool quiet = false;
};

/// A log that was simulated can be simulated again; any other is not ours to replace.
void CheckOutput(const SimulateArguments& arguments) {
  namespace fs = std::filesystem;
  if (!fs::exists(fs::symlink_status(arguments.log)) || arguments.force) return;
  if (fs::is_directory(arguments.log)) throw InputError(arguments.log + " is a folder");
  if (!fs::exists(PathsOf(arguments.log).truth)) {
    throw InputError(arguments.log +
                     " exists and is no simulated log (no truth beside it); --force replaces it");
  }
}

std::vector<std::size_t> FloorsCalled(const Building& building,
                                      const std::vector<std::string>& labels) {
  std::vector<std::string> known;
  for (const FloorPlan& floor : building.floors) known.push_back(floor.label);
  std::vector<std::size_t> floors;
  for (const std::string& label : labels) {
    const auto found = std::find(known.begin(), known.end(), label);
    if (found == known.end()) {
      throw InputError("--visits: " + building.name + " has no floor `" + label + "`" +
                       DidYouMean(label, known));
    }
    floors.push_back(static_cast<std::size_t>(found - known.begin()));
  }
  return floors;
}

/// Text has no word for clouds.
void ChooseLidar(const SimulateArguments& arguments, SimulationOptions* options) {
  if (arguments.lidar == "2d") return;
  const std::optional<SpaceLidarModel> model = SpaceLidarCalled(arguments.lidar);
  if (!model) {
    std::vector<std::string> known = SpaceLidarNames();
    known.insert(known.begin(), "2d");
    throw InputError("--lidar: there is no lidar `" + arguments.lidar + "`" +
                     DidYouMean(arguments.lidar, known));
  }
  const std::string ending = std::filesystem::path(arguments.log).extension().string();
  if (ending != ".bag" && ending != ".mcap") {
    throw InputError("--lidar " + arguments.lidar + ": " + arguments.log +
                     " is text, which has no word for clouds; name it .bag or .mcap");
  }
  options->space_lidar = OptionsOf(*model);
  if (arguments.lidar_rate_hz > 0.0) options->space_lidar->rate = arguments.lidar_rate_hz;
}

int RunSimulate(const SimulateArguments& arguments) {
  CheckOutput(arguments);
  const Building building = LoadBuilding(arguments.building, arguments.seed);
  SimulationOptions options;
  options.seed = arguments.seed;
  options.tour = arguments.tour;
  options.length = arguments.length_m;
  options.visits = FloorsCalled(building, arguments.visits);
  options.floor_labels = arguments.floor_labels;
  ChooseLidar(arguments, &options);
  constexpr double kImuRate = 100.0;  // Hz
  if (arguments.with_imu) options.acceleration.rate = kImuRate;
  if (arguments.without_pressure) options.pressure.rate = 0.0;
  const SimulationNoise noise = arguments.perfect ? SimulationNoise::None() : SimulationNoise{};

  CatchInterrupts();
  ProgressBar progress(arguments.quiet);
  progress.Stage("simulating");
  const SimulationSummary summary =
      SimulateToFiles(building, options, noise, arguments.log,
                      [&](double fraction) { progress.Progress(fraction, 0); });
  progress.Finish();
  const SimulationPaths paths = PathsOf(arguments.log);
  if (!arguments.quiet) {
    std::printf("%s: %llu scans, %.0f m, %.0f s, %llu changes of floor; truth: %s, %s\n",
                paths.log.c_str(), static_cast<unsigned long long>(summary.scans), summary.length,
                summary.seconds, static_cast<unsigned long long>(summary.floor_changes),
                paths.truth.c_str(), paths.truth_floors.c_str());
    const Pose2& start = summary.T_building_world;
    std::printf("start: floor %s, at %.6f m, %.6f m, %.9f rad of the building\n",
                summary.start_floor.c_str(), start.x, start.y, start.theta);
  }
  return 0;
}

std::string BuildingHelp() {
  std::string names;
  for (const std::string& name : BuildingNames()) names += (names.empty() ? "" : ", ") + name;
  return "one of " + names + "; or a building file";
}

}  // namespace

void AddSimulateCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command =
      program.add_subcommand("simulate", "Write the log of a robot in a simulated building");
  command->add_option("--building", arguments->building, BuildingHelp())
      ->required()
      ->type_name("NAME|FILE");
  command
      ->add_option("-o,--output", arguments->log,
                   "the log to write: text (.gz packs it), or a bag by its name (.bag, .mcap)")
      ->required()
      ->type_name("LOG");
  command->add_option("--seed", arguments->seed, "of every random number: same seed, same bytes")
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--tour", arguments->tour,
                   "another drive through the same building: other start, way and noise")
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--length", arguments->length_m,
                   "go on until the tour is this long, m; 0: every corridor once")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->type_name("METRES");
  command->add_option("--visits", arguments->visits, "floors in order of visiting, such as 0,7,3,0")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LABEL,...");
  command
      ->add_option("--lidar", arguments->lidar,
                   "2d, or a 3D one, whose clouds need a bag: vlp16, os1-32, mid360")
      ->capture_default_str()
      ->type_name("MODEL");
  command
      ->add_option("--lidar-rate", arguments->lidar_rate_hz,
                   "record so many clouds of a 3D lidar a second, Hz; 0: all")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str()
      ->type_name("HZ");
  command->add_flag("--perfect", arguments->perfect, "no noise, no drift, no people");
  command->add_flag("--floor-labels", arguments->floor_labels,
                    "write FLOOR lines, as an elevator's interface would");
  command->add_flag("--without-pressure", arguments->without_pressure, "no barometer");
  command->add_flag(
      "--with-imu", arguments->with_imu,
      "an accelerometer of a cheap IMU, 100 Hz: noise, bias, vibration while driving");
  command->add_flag("--force", arguments->force, "replace a log that was not simulated");
  command->add_flag("--quiet", arguments->quiet, "print errors only");
  command->footer(
      "Examples:\n"
      "  masked_mapper simulate --building office -o office.log.gz\n"
      "  masked_mapper simulate --building campus -o campus.log.gz --seed 7 --length 5000\n"
      "  masked_mapper simulate --building campus -o again.log.gz --seed 7 --tour 2\n"
      "  masked_mapper simulate --building office -o office.mcap\n"
      "  masked_mapper simulate --building office --lidar vlp16 -o office_3d.mcap\n"
      "\n"
      "Beside LOG (without its .gz) stand LOG.truth.tum, the true pose at every scan, and\n"
      "LOG.truth_floors.csv, the true floor.");
  command->callback([arguments, &run] { run = [arguments] { return RunSimulate(*arguments); }; });
}

}  // namespace masked_mapper
