// SPDX-License-Identifier: BSD-3-Clause
// Reading: the parsing alone, a whole log from a simulated robot, and a real one from its gzip.
#include <benchmark/benchmark.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "log/carmen_line.hpp"
#include "masked_mapper/log/log_reader.hpp"

namespace masked_mapper {
namespace {

/// A scan of 361 beams as the simulation writes it.
std::string RobotLaserLine() {
  std::string line =
      "ROBOTLASER1 0 -2.356194490192 4.712388980385 0.013089969389 30.000 0.01 0 361";
  for (int beam = 0; beam < 361; ++beam) {
    char range[16];
    std::snprintf(range, sizeof(range), " %.3f", 0.5 + 0.079 * beam);
    line += range;
  }
  return line + " 0 1.000000 2.000000 0.5 1.000000 2.000000 0.5 0 0 0 0 0 12.5 nohost 12.5\n";
}

void BM_ParseScanLine(benchmark::State& state) {
  const std::string line = RobotLaserLine();
  const bool read_ranges = state.range(0) != 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        ParseCarmenLine(line.data(), line.data() + line.size() - 1, read_ranges));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * line.size()));
}
BENCHMARK(BM_ParseScanLine)->ArgName("ranges")->Arg(1)->Arg(0);

void BM_ReadLog(benchmark::State& state, const char* name) {
  const std::string path = std::string(MASKED_MAPPER_REAL_LOGS) + "/" + name;
  if (!std::filesystem::exists(path)) {
    state.SkipWithError((path + " is not here").c_str());
    return;
  }
  std::int64_t scans = 0;
  for (auto _ : state) {
    const std::unique_ptr<LogReader> reader = OpenLog(path, {});
    while (reader->Next()) {
    }
    scans += static_cast<std::int64_t>(reader->Statistics().scans);
  }
  state.SetItemsProcessed(scans);
}
BENCHMARK_CAPTURE(BM_ReadLog, aces, "data/aces.clf.gz")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadLog, mit_csail_bag, "bags/mit-csail.bag")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace masked_mapper
