// SPDX-License-Identifier: BSD-3-Clause
// `map` on logs whose sensors are wrong in ways that real ones are: what it says, and what the map
// is still worth. One drive on two floors, 0 to 250 s below, 262 to 487 s above, from 499 s below
// again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/program.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

using Words = std::vector<std::string>;
using Spoil = std::function<void(std::vector<Words>*)>;

constexpr double kBegin = 1'500'000'000.0;  // s, of simulated logs

double Seconds(const Words& line) { return std::stod(line[line.size() - 3]) - kBegin; }
bool IsScan(const Words& line) { return line.front() == "ROBOTLASER1"; }
std::size_t Beams(const Words& line) { return std::stoul(line[8]); }

std::string Text(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6f", value);
  return text;
}

/// Simulated once for all tests of this program.
struct OfficeDrive {
  ScratchFolder folder;
  std::vector<Words> lines;

  OfficeDrive() {
    const std::string log = folder / "office.log";
    EXPECT_EQ(RunProgram({"simulate", "--building", "office", "-o", log, "--quiet"}).code, 0);
    std::istringstream in(ReadText(log));
    for (std::string line; std::getline(in, line);) {
      if (line.empty() || line.front() == '#') continue;
      std::istringstream words(line);
      lines.emplace_back(std::istream_iterator<std::string>(words),
                         std::istream_iterator<std::string>());
    }
  }
};

const OfficeDrive& Office() {
  static const OfficeDrive drive;
  return drive;
}

void Keep(std::vector<Words>* lines, const std::function<bool(const Words&)>& keeps) {
  lines->erase(
      std::remove_if(lines->begin(), lines->end(), [&](const Words& line) { return !keeps(line); }),
      lines->end());
}

/// `measure` has pascal and time; NaN leaves the reading out.
Spoil Pressure(std::function<double(double, double)> measure) {
  return [measure = std::move(measure)](std::vector<Words>* lines) {
    for (Words& line : *lines) {
      if (line.front() != "PRESSURE") continue;
      line[1] = Text(measure(std::stod(line[1]), Seconds(line)));
    }
    Keep(lines, [](const Words& line) { return line[1] != "nan" && line[1] != "-nan"; });
  };
}

Spoil Scans(std::function<void(Words*)> spoil) {
  return [spoil = std::move(spoil)](std::vector<Words>* lines) {
    for (Words& line : *lines) {
      if (IsScan(line)) spoil(&line);
    }
  };
}

Spoil Labels(std::vector<std::pair<double, std::string>> labels) {
  return [labels = std::move(labels)](std::vector<Words>* lines) {
    for (const auto& [seconds, label] : labels) {
      const Words line = {"FLOOR", label, Text(kBegin + seconds), "robot", "0"};
      lines->insert(std::find_if(lines->begin(), lines->end(),
                                 [s = seconds](const Words& other) { return Seconds(other) >= s; }),
                    line);
    }
  };
}

void Mirror(Words* line) {
  std::reverse(line->begin() + 9, line->begin() + 9 + static_cast<std::ptrdiff_t>(Beams(*line)));
}

void Blank(Words* line) { std::fill_n(line->begin() + 9, Beams(*line), "81.91"); }

/// The six words of where the laser and the robot were.
std::size_t PosesAt(const Words& line) {
  return 10 + Beams(line) + std::stoul(line[9 + Beams(line)]);
}

/// The log says that the scanner sits elsewhere than it does.
Spoil SaidElsewhere(const Pose2& T_laser_said) {
  return Scans([T_laser_said](Words* line) {
    const std::size_t at = PosesAt(*line);
    const Pose2 laser{std::stod((*line)[at]), std::stod((*line)[at + 1]),
                      std::stod((*line)[at + 2])};
    const Pose2 said = laser * T_laser_said;
    (*line)[at] = Text(said.x);
    (*line)[at + 1] = Text(said.y);
    (*line)[at + 2] = Text(said.theta);
  });
}

struct SensorCase {
  const char* name;
  Spoil spoil;
  const char* said;          ///< in what the program prints; empty: no warning at all
  std::size_t floors;        ///< 0: not looked at
  double mean_error_m;       ///< at most, aligned; 0: not looked at
  std::string setting = {};  ///< key=value
};
void PrintTo(const SensorCase& sensor, std::ostream* out) { *out << sensor.name; }

class BadSensors : public ::testing::TestWithParam<SensorCase> {};

TEST_P(BadSensors, AreSaidAndBorne) {
  const SensorCase& sensor = GetParam();
  const ScratchFolder folder;
  std::vector<Words> lines = Office().lines;
  sensor.spoil(&lines);
  std::string text;
  for (const Words& line : lines) {
    for (const std::string& word : line) text += word + " ";
    text.back() = '\n';
  }
  WriteText(folder / "bad.log", text);
  std::vector<std::string> arguments = {"map", folder / "bad.log", "-o", folder / "out"};
  if (!sensor.setting.empty()) arguments.insert(arguments.end(), {"--set", sensor.setting});
  const Ran ran = RunProgram(arguments);
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::size_t first = ran.err.find("warning");
  if (*sensor.said == '\0') {
    EXPECT_EQ(first, std::string::npos) << ran.err;
  } else {
    EXPECT_TRUE(Contains(ran.err, sensor.said)) << ran.err;
    EXPECT_EQ(ran.err.find(sensor.said), ran.err.rfind(sensor.said)) << "said once: " << ran.err;
  }
  const auto summary = nlohmann::json::parse(ReadText(folder / "out/summary.json"));
  if (sensor.floors > 0) {
    EXPECT_EQ(summary.at("floors").size(), sensor.floors);
  }
  if (sensor.mean_error_m > 0.0) {
    const Ran evaluated = RunProgram({"evaluate", folder / "out", "--truth",
                                      Office().folder / "office.log.truth.tum", "--json"});
    ASSERT_EQ(evaluated.code, 0) << evaluated.err;
    const auto trajectory = nlohmann::json::parse(evaluated.out).at("trajectory");
    EXPECT_LT(trajectory.at("aligned").at("mean_m"), sensor.mean_error_m) << "m";
  }
}

INSTANTIATE_TEST_SUITE_P(MapCommand, BadSensors,
                         ::testing::Values(SensorCase{"None", [](std::vector<Words>*) {}, "", 2,
                                                      0.1},
                                           SensorCase{"LabelsAgainstPressure",
                                                      Labels({{0, "0"}, {100, "1"}, {200, "0"}}),
                                                      "contradict each other", 2, 0.0},
                                           SensorCase{"AFloorOfOneSecond",
                                                      Labels({{0, "0"},
                                                              {150, "2"},
                                                              {151, "0"},
                                                              {249, "-"},
                                                              {261.5, "1"},
                                                              {487, "-"},
                                                              {499.5, "0"}}),
                                                      "contradict each other", 3, 0.1},
                                           SensorCase{"HectopascalsForPascals",
                                                      Pressure([](double pascal, double) {
                                                        return pascal / 100.0;
                                                      }),
                                                      "hectopascals", 2, 0.1},
                                           SensorCase{"PressureOfZero",
                                                      Pressure([](double, double) { return 0.0; }),
                                                      "constantly 0", 0, 0.1},
                                           SensorCase{"PressureWithSpikes",
                                                      Pressure([](double pascal, double seconds) {
                                                        return static_cast<int>(2.0 * seconds) %
                                                                           50 ==
                                                                       7
                                                                   ? pascal + 9000.0
                                                                   : pascal;
                                                      }),
                                                      "none of air", 2, 0.1},
                                           SensorCase{"PressureWithGaps",
                                                      Pressure([](double pascal, double seconds) {
                                                        const bool is_gap =
                                                            (seconds > 100.0 && seconds < 160.0) ||
                                                            (seconds > 240.0 && seconds < 275.0);
                                                        return is_gap ? std::nan("") : pascal;
                                                      }),
                                                      "", 2, 0.1},
                                           SensorCase{"BeginsInTheElevator",
                                                      [](std::vector<Words>* lines) {
                                                        Keep(lines, [](const Words& line) {
                                                          return Seconds(line) > 255.0;
                                                        });
                                                      },
                                                      "", 2, 0.1},
                                           SensorCase{"EndsInTheElevator",
                                                      [](std::vector<Words>* lines) {
                                                        Keep(lines, [](const Words& line) {
                                                          return Seconds(line) < 493.0;
                                                        });
                                                      },
                                                      "", 2, 0.1},
                                           SensorCase{"OneScanPerSecond",
                                                      [](std::vector<Words>* lines) {
                                                        int n = 0;
                                                        Keep(lines, [&](const Words& line) {
                                                          return !IsScan(line) || n++ % 5 == 0;
                                                        });
                                                      },
                                                      "", 2, 0.1},
                                           SensorCase{"ScansThatStopForTenSeconds",
                                                      [](std::vector<Words>* lines) {
                                                        Keep(lines, [](const Words& line) {
                                                          const double seconds = Seconds(line);
                                                          return !IsScan(line) || seconds < 60.0 ||
                                                                 std::fmod(seconds, 90.0) >= 10.0;
                                                        });
                                                      },
                                                      "", 2, 0.3},
                                           SensorCase{"UpsideDown", Scans(Mirror),
                                                      "log.upside_down=true", 0, 0.0},
                                           SensorCase{"UpsideDownAndSaidSo", Scans(Mirror), "", 2,
                                                      0.1, "log.upside_down=true"},
                                           SensorCase{"LooksElsewhere",
                                                      SaidElsewhere({0.0, 0.0, 0.3}),
                                                      "log.laser_theta_deg=", 0, 0.0},
                                           SensorCase{"SitsElsewhere",
                                                      SaidElsewhere({-0.5, 0.3, 0.0}),
                                                      "sitting elsewhere", 0, 0.0},
                                           SensorCase{"NoReturnsForAWhile", Scans([](Words* line) {
                                                        if (Seconds(*line) > 100.0 &&
                                                            Seconds(*line) < 130.0)
                                                          Blank(line);
                                                      }),
                                                      "without a single return", 2, 0.2},
                                           SensorCase{"NoReturnsAtAll",
                                                      Scans(Blank), "without a single return", 2,
                                                      0.0},
                                           SensorCase{
                                               "OdometryThatNeverMoves",
                                               [](std::vector<Words>* lines) {
                                                 Keep(lines, [](const Words& line) {
                                                   return line.front() != "ODOM";
                                                 });
                                                 for (Words& line : *lines) {
                                                   if (IsScan(line)) {
                                                     std::fill_n(
                                                         line.begin() + static_cast<std::ptrdiff_t>(
                                                                            PosesAt(line)),
                                                         6, "0");
                                                   }
                                                 }
                                               },
                                               "never moves", 0, 0.5}),
                         [](const ::testing::TestParamInfo<SensorCase>& info) {
                           return std::string(info.param.name);
                         });

}  // namespace
}  // namespace masked_mapper
