// SPDX-License-Identifier: BSD-3-Clause
// Where a mask would make scan nodes: `masked_mapper_example_mask LOG 'any(doorways,openings)'`.
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <variant>

#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/masks/mask_registry.hpp"

namespace masked_mapper {
namespace {

constexpr double kMinEdgeLength = 1.5;  ///< m, Section III-B

void ListNodes(const std::string& path, const std::string& expression) {
  const auto mask = MakeMask(expression, MaskOptions{});
  const auto log = OpenLog(path, LogOptions{});
  std::optional<Pose2> T_odom_node;
  while (const auto observation = log->Next()) {
    const auto* scan = std::get_if<LaserScan>(&*observation);
    if (scan == nullptr || !scan->T_odom_robot) continue;
    const Pose2& T_odom_robot = *scan->T_odom_robot;
    mask->Observe({*scan, T_odom_robot});
    if (T_odom_node && (!mask->Fires() || Distance(*T_odom_node, T_odom_robot) <= kMinEdgeLength)) {
      continue;
    }
    mask->OnNode();
    T_odom_node = T_odom_robot;
    std::printf("%.3f %.3f %.3f %.4f\n", scan->stamp, T_odom_robot.x, T_odom_robot.y,
                T_odom_robot.theta);
  }
}

void PrintUsage(const char* program) {
  std::string masks;
  for (const std::string& name : RegisteredMasks()) masks += (masks.empty() ? "" : ", ") + name;
  std::printf("usage: %s LOG MASK\nmasks: %s\n", program, masks.c_str());
}

}  // namespace
}  // namespace masked_mapper

int main(int argc, char** argv) {
  if (argc != 3) {
    masked_mapper::PrintUsage(argv[0]);
    return argc == 1 ? 0 : 2;
  }
  try {
    masked_mapper::ListNodes(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
