// SPDX-License-Identifier: BSD-3-Clause
#include "carmen_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

#include "masked_mapper/log/floor_file.hpp"

namespace masked_mapper {
namespace {

// Nothing on Earth is farther, and squares of it still are exact enough: UTM northings are below
// 1e7 m.
constexpr double kLargestCoordinate = 1e8;
// About 30 000 years, in seconds.
constexpr double kLargestStamp = 1e12;
constexpr std::size_t kMostBeams = 100000;

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Walks through the words of a line.
class Words {
 public:
  Words(const char* begin, const char* end) : cursor_(begin), end_(end) {}

  std::string_view Next() {
    while (cursor_ < end_ && IsBlank(*cursor_)) ++cursor_;
    const char* begin = cursor_;
    while (cursor_ < end_ && !IsBlank(*cursor_)) ++cursor_;
    return {begin, static_cast<std::size_t>(cursor_ - begin)};
  }

  std::optional<double> Number() { return ParseNumber(cursor_, end_); }

  /// A number no larger than `limit` either way.
  bool Read(double limit, double* value) {
    const std::optional<double> number = Number();
    if (!number || !(std::abs(*number) <= limit)) return false;
    *value = *number;
    return true;
  }

  bool Read(Pose2* pose) {
    if (!Read(kLargestCoordinate, &pose->x) || !Read(kLargestCoordinate, &pose->y) ||
        !Read(kLargestCoordinate, &pose->theta)) {
      return false;
    }
    pose->theta = WrapAngle(pose->theta);
    return true;
  }

  /// A count that the rest of the line can hold.
  bool ReadCount(std::size_t* count) {
    const std::string_view word = Next();
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), *count);
    return error == std::errc() && stop == word.data() + word.size();
  }

  bool Skip(std::size_t count) {
    for (; count > 0; --count) {
      if (Next().empty()) return false;
    }
    return true;
  }

  /// `ipc_timestamp host logger_timestamp`, and nothing behind.
  bool ReadStampAndEnd(double* stamp) {
    return Read(kLargestStamp, stamp) && Skip(2) && Next().empty();
  }

  std::size_t CountRest() const {
    Words rest = *this;
    std::size_t count = 0;
    while (!rest.Next().empty()) ++count;
    return count;
  }

  std::size_t BytesLeft() const { return static_cast<std::size_t>(end_ - cursor_); }

 private:
  const char* cursor_;
  const char* end_;
};

CarmenError Malformed(std::string_view name, const char* what) {
  return {std::string(name) + ": " + what};
}

/// `count` ranges; a word that is no number spoils the line.
bool ReadRanges(std::size_t count, bool keep, Words* words, std::vector<float>* ranges) {
  if (!keep) return words->Skip(count);
  ranges->resize(count);
  for (float& range : *ranges) {
    const std::optional<double> number = words->Number();
    if (!number) return false;
    constexpr double kLargest = std::numeric_limits<float>::max();
    range = static_cast<float>(std::isfinite(*number) ? std::clamp(*number, -kLargest, kLargest)
                                                      : *number);
  }
  return true;
}

/// Says how many ranges a line with a wrong count has, given the words that must follow them.
CarmenError WrongCount(std::string_view name, std::size_t expected, std::size_t words_after_count,
                       std::size_t words_after_ranges) {
  if (words_after_count < words_after_ranges) return Malformed(name, "the line is cut");
  const std::size_t found = words_after_count - words_after_ranges;
  if (found == expected) return Malformed(name, "a field is not a number, or out of all bounds");
  return {std::string(name) + ": expected " + std::to_string(expected) + " ranges, found " +
          std::to_string(found)};
}

/// The count and the ranges themselves. Two bytes per range are the least that a line can spend, so
/// a hostile count allocates nothing.
bool ReadCountedRanges(bool keep, Words* words, CarmenScan* scan) {
  return scan->beams > 0 && scan->beams <= kMostBeams && 2 * scan->beams <= words->BytesLeft() &&
         ReadRanges(scan->beams, keep, words, &scan->ranges);
}

CarmenLine ParseFlaser(std::string_view name, Words words, bool read_ranges) {
  CarmenScan scan;
  if (!words.ReadCount(&scan.beams)) return Malformed(name, "no number of ranges");
  const Words after_count = words;
  if (ReadCountedRanges(read_ranges, &words, &scan) && words.Read(&scan.T_odom_laser) &&
      words.Read(&scan.T_odom_robot) && words.ReadStampAndEnd(&scan.stamp)) {
    return scan;
  }
  return WrongCount(name, scan.beams, after_count.CountRest(), 9);
}

CarmenLine ParseRobotLaser(std::string_view name, Words words, bool read_ranges) {
  CarmenScan scan;
  scan.is_flaser = false;
  const bool has_header =
      words.Skip(1) && words.Read(10.0, &scan.start_angle) &&
      words.Read(10.0, &scan.field_of_view) && words.Read(10.0, &scan.angle_step) &&
      words.Read(std::numeric_limits<double>::max(), &scan.maximum_range) && words.Skip(2);
  if (!has_header) return Malformed(name, "the laser's description is not readable");
  if (!words.ReadCount(&scan.beams)) return Malformed(name, "no number of ranges");
  const Words after_count = words;
  std::size_t remissions = 0;
  if (ReadCountedRanges(read_ranges, &words, &scan) && words.ReadCount(&remissions) &&
      2 * remissions <= words.BytesLeft() && words.Skip(remissions) &&
      words.Read(&scan.T_odom_laser) && words.Read(&scan.T_odom_robot) && words.Skip(5) &&
      words.ReadStampAndEnd(&scan.stamp)) {
    return scan;
  }
  const std::size_t rest = after_count.CountRest();
  if (rest == scan.beams + remissions + 15) {
    return Malformed(name, "a field is not a number, or out of all bounds");
  }
  return {CarmenError{std::string(name) + ": " + std::to_string(scan.beams) +
                      " ranges announced, but the line has " + std::to_string(rest) +
                      " words after that"}};
}

CarmenLine ParseOdometry(std::string_view name, Words words) {
  OdometryReading reading;
  if (words.Read(&reading.T_odom_robot) && words.Skip(3) && words.ReadStampAndEnd(&reading.stamp)) {
    return reading;
  }
  return Malformed(name, "expected x y theta tv rv accel ipc_timestamp host logger_timestamp");
}

CarmenLine ParsePressure(std::string_view name, Words words) {
  PressureReading reading;
  if (words.Read(1e9, &reading.pressure_pa) && words.ReadStampAndEnd(&reading.stamp))
    return reading;
  return Malformed(name, "expected pascal ipc_timestamp host logger_timestamp");
}

CarmenLine ParseAcceleration(std::string_view name, Words words) {
  AccelerationReading reading;
  Eigen::Vector3d& acceleration = reading.acceleration_in_robot;
  if (words.Read(1e6, &acceleration.x()) && words.Read(1e6, &acceleration.y()) &&
      words.Read(1e6, &acceleration.z()) && words.ReadStampAndEnd(&reading.stamp)) {
    return reading;
  }
  return Malformed(name, "expected ax ay az ipc_timestamp host logger_timestamp");
}

CarmenLine ParseFloor(std::string_view name, Words words) {
  FloorLabel reading;
  reading.label = std::string(words.Next());
  if (!words.ReadStampAndEnd(&reading.stamp)) {
    return Malformed(name, "expected label ipc_timestamp host logger_timestamp");
  }
  if (!IsFloorLabel(reading.label)) {
    return Malformed(name, "a label is made of A-Z a-z 0-9 _ . - and is not . or ..");
  }
  return reading;
}

/// A message's name as CARMEN has them; anything else at the start of a line is garbage.
bool IsMessageName(std::string_view word) {
  const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  return word.size() <= 40 && is_letter(word.front()) &&
         std::all_of(word.begin(), word.end(), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
         });
}

/// Plain decimals of up to 18 digits, exactly: digits and power of ten are exact in a double as
/// long as they stay below 2^53 and 10^22, so that one division rounds once, as std::from_chars
/// would.
std::optional<double> ParsePlainDecimal(const char*& cursor) {
  static constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                            1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                            1e14, 1e15, 1e16, 1e17, 1e18};
  constexpr std::uint64_t kLargestExact = std::uint64_t{1} << 53;
  const char* at = cursor;
  const bool negative = *at == '-';
  if (negative) ++at;
  std::uint64_t digits = 0;
  const char* const first = at;
  while (static_cast<unsigned char>(*at - '0') < 10) {
    digits = 10 * digits + static_cast<std::uint64_t>(*at++ - '0');
  }
  std::ptrdiff_t count = at - first;
  std::ptrdiff_t decimals = 0;
  if (*at == '.') {
    const char* const fraction = ++at;
    while (static_cast<unsigned char>(*at - '0') < 10) {
      digits = 10 * digits + static_cast<std::uint64_t>(*at++ - '0');
    }
    decimals = at - fraction;
    count += decimals;
  }
  if (count == 0 || count > 18 || digits > kLargestExact || (*at | 0x20) == 'e')
    return std::nullopt;
  cursor = at;
  const double magnitude = static_cast<double>(digits) / kPowersOfTen[decimals];
  return negative ? -magnitude : magnitude;
}

std::optional<double> ParseGeneralNumber(const char*& cursor, const char* end) {
  const char* begin = cursor;
  if (begin < end && *begin == '+') ++begin;
  double value = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument) return std::nullopt;
  // Too large and too small both come as out of range; neither is a measurement.
  if (error == std::errc::result_out_of_range) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    value = *begin == '-' ? -kLargest : kLargest;
  }
  cursor = stop;
  return value;
}

}  // namespace

std::optional<double> ParseNumber(const char*& cursor, const char* end) {
  while (cursor < end && IsBlank(*cursor)) ++cursor;
  if (cursor == end) return std::nullopt;
  const char* at = cursor;
  std::optional<double> value = ParsePlainDecimal(at);
  if (!value) value = ParseGeneralNumber(at, end);
  if (!value || (at < end && !IsBlank(*at))) return std::nullopt;
  cursor = at;
  return value;
}

CarmenLine ParseCarmenLine(const char* begin, const char* end, bool read_ranges) {
  Words words(begin, end);
  const std::string_view name = words.Next();
  if (name.empty() || name.front() == '#') return CarmenNothing{};
  if (name == "FLASER") return ParseFlaser(name, words, read_ranges);
  if (name == "ROBOTLASER1") return ParseRobotLaser(name, words, read_ranges);
  if (name == "ODOM") return ParseOdometry(name, words);
  if (name == "PRESSURE") return ParsePressure(name, words);
  if (name == "ACCEL") return ParseAcceleration(name, words);
  if (name == "FLOOR") return ParseFloor(name, words);
  if (name == "PARAM") {
    CarmenParam param;
    param.name = std::string(words.Next());
    param.value = std::string(words.Next());
    return param;
  }
  if (IsMessageName(name)) return CarmenOther{std::string(name)};
  return CarmenError{"not a message"};
}

}  // namespace masked_mapper
