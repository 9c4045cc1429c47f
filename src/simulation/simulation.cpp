// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/simulation/simulation.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "masked_mapper/log/log_writer.hpp"
#include "simulate.hpp"

namespace masked_mapper {
namespace {

/// A file under a name of its own until it is complete, and removed if that never comes.
class PendingFile {
 public:
  explicit PendingFile(const std::string& path) : path_(path) {
    const std::filesystem::path whole(path);
    // The ending stays last: it says whether the log is gzip.
    pending_ =
        (whole.parent_path() / (whole.stem().string() + ".part" + whole.extension().string()))
            .string();
  }
  ~PendingFile() {
    std::error_code ignored;
    if (!complete_) std::filesystem::remove(pending_, ignored);
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::string& pending() const { return pending_; }
  void Complete() {
    std::error_code error;
    std::filesystem::rename(pending_, path_, error);
    if (error) throw std::runtime_error(path_ + ": cannot be written: " + error.message());
    complete_ = true;
  }

 private:
  std::string path_;
  std::string pending_;
  bool complete_ = false;
};

class TextFile {
 public:
  explicit TextFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    if (!file_) throw std::runtime_error(path + ": cannot be created");
  }
  void Number(double value, int decimals) {
    std::array<char, 64> digits;
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                            std::chars_format::fixed, decimals);
    static_cast<void>(error);
    file_.write(digits.data(), end - digits.data());
  }
  void Text(const std::string& text) { file_ << text; }
  void Close() {
    file_.close();
    if (!file_) throw std::runtime_error(path_ + ": cannot be written");
  }

 private:
  std::string path_;
  std::ofstream file_;
};

/// As many digits as the simulated scanner's ranges have.
int RangeDecimals(const LidarNoise& noise) {
  if (noise.resolution >= 0.01) return 2;
  return noise.resolution >= 0.001 ? 3 : 6;
}

}  // namespace

SimulationPaths PathsOf(const std::string& log_path) {
  const std::string ending = ".gz";
  std::string base = log_path;
  if (base.size() > ending.size() &&
      base.compare(base.size() - ending.size(), ending.size(), ending) == 0) {
    base.resize(base.size() - ending.size());
  }
  return {log_path, base + ".truth.tum", base + ".truth_floors.csv"};
}

SimulationSummary SimulateToFiles(const Building& building, const SimulationOptions& options,
                                  const SimulationNoise& noise, const std::string& log_path,
                                  const std::function<void(double)>& progress) {
  const SimulationPaths paths = PathsOf(log_path);
  PendingFile pending_log(paths.log);
  PendingFile pending_truth(paths.truth);
  PendingFile pending_floors(paths.truth_floors);
  LogWriter log(pending_log.pending(), RangeDecimals(noise.lidar));
  TextFile truth(pending_truth.pending());
  TextFile floors(pending_floors.pending());

  log.WriteComment("simulated building " + building.name + ", seed " +
                   std::to_string(options.seed) +
                   (options.tour == 1 ? "" : ", tour " + std::to_string(options.tour)));
  floors.Text("t,label\n");
  SimulationSink sink;
  sink.observation = [&](const Observation& observation) { log.Write(observation); };
  sink.cloud = [&](const CloudReading& cloud) { log.WriteCloud(cloud); };
  sink.truth = [&](const TruthPose& pose) {
    constexpr int kDecimals = 6;
    truth.Number(pose.stamp, kDecimals);
    for (const double value :
         {pose.T_world_robot.x, pose.T_world_robot.y, pose.elevation, 0.0, 0.0}) {
      truth.Text(" ");
      truth.Number(value, kDecimals);
    }
    for (const double value :
         {std::sin(0.5 * pose.T_world_robot.theta), std::cos(0.5 * pose.T_world_robot.theta)}) {
      truth.Text(" ");
      truth.Number(value, 9);
    }
    truth.Text("\n");
    floors.Number(pose.stamp, kDecimals);
    floors.Text("," + pose.floor + "\n");
  };
  sink.progress = progress;
  SimulationSummary summary = Simulate(building, options, noise, sink);
  log.Close();
  truth.Close();
  floors.Close();
  pending_log.Complete();
  pending_truth.Complete();
  pending_floors.Complete();
  return summary;
}

}  // namespace masked_mapper
