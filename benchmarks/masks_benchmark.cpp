// SPDX-License-Identifier: BSD-3-Clause
// What a mask costs per scan of real buildings. The openings mask looks only at the scans that the
// robot's motion makes new, FindOpenings at every one.
#include <benchmark/benchmark.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/masks/mask_registry.hpp"
#include "masks/openings.hpp"

namespace masked_mapper {
namespace {

const char* const kLogs[] = {"aces", "fr079", "mit-csail"};

/// Empty, and the benchmark skipped, where the log is not there.
std::vector<LaserScan> ReadScans(benchmark::State& state) {
  const std::string name = kLogs[state.range(0)];
  std::vector<LaserScan> scans;
  try {
    const auto log = OpenLog(MASKED_MAPPER_REAL_LOGS "/data/" + name + ".clf.gz", LogOptions());
    while (auto observation = log->Next()) {
      if (auto* scan = std::get_if<LaserScan>(&*observation)) scans.push_back(std::move(*scan));
    }
    state.SetLabel(name + ", " + std::to_string(scans.front().size()) + " beams");
  } catch (const std::runtime_error&) {
    state.SkipWithError("no real log to take scans from");
  }
  return scans;
}

template <typename PerScan>
void ForEveryScan(benchmark::State& state, const PerScan& per_scan) {
  const std::vector<LaserScan> scans = ReadScans(state);
  if (scans.empty()) return;
  std::size_t next = 0;
  for (auto _ : state) {
    per_scan(scans[next]);
    next = (next + 1) % scans.size();
  }
}

void BM_FindOpenings(benchmark::State& state) {
  ForEveryScan(state, [](const LaserScan& scan) {
    benchmark::DoNotOptimize(FindOpenings(scan, OpeningOptions()));
  });
}
BENCHMARK(BM_FindOpenings)->DenseRange(0, 2);

void BM_Mask(benchmark::State& state, const char* expression) {
  const auto mask = MakeMask(expression, MaskOptions());
  ForEveryScan(state, [&](const LaserScan& scan) {
    mask->Observe({scan, scan.T_odom_robot.value_or(Pose2())});
    benchmark::DoNotOptimize(mask->Fires());
  });
}
BENCHMARK_CAPTURE(BM_Mask, openings, "openings")->DenseRange(0, 2);
BENCHMARK_CAPTURE(BM_Mask, eccentricity, "eccentricity")->DenseRange(0, 2);

}  // namespace
}  // namespace masked_mapper
