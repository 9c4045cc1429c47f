// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/log_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "carmen_line.hpp"
#include "log_sink.hpp"
#include "masked_mapper/log/floor_file.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "mcap_writer.hpp"
#include "ros1_bag_writer.hpp"
#include "ros_log_writer.hpp"
#include "scan_calibration.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kBufferSize = 256 * 1024;
constexpr int kPoseDecimals = 6;
constexpr int kAngleDecimals = 12;  // a step is multiplied by hundreds of beams
constexpr const char* kHost = "nohost";

bool HasEnding(const std::string& path, const std::string& ending) {
  return path.size() >= ending.size() &&
         path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

/// The file, plain or gzip by its name.
class TextSink {
 public:
  explicit TextSink(const std::string& path) : path_(path) {
    const bool is_gzip = HasEnding(path, ".gz");
    // Level 4: half the time of the default for a tenth more bytes, on ranges.
    if (is_gzip) {
      gzip_ = gzopen(path.c_str(), "wb4");
    } else {
      plain_ = std::fopen(path.c_str(), "wb");
    }
    if (gzip_ == nullptr && plain_ == nullptr) {
      throw std::runtime_error(path + ": cannot be created: " + std::strerror(errno));
    }
  }
  ~TextSink() { CloseFile(); }
  TextSink(const TextSink&) = delete;
  TextSink& operator=(const TextSink&) = delete;

  void Write(const std::string& text) {
    if (text.empty()) return;
    const std::size_t written =
        gzip_ != nullptr ? static_cast<std::size_t>(std::max(
                               0, gzwrite(gzip_, text.data(), static_cast<unsigned>(text.size()))))
                         : std::fwrite(text.data(), 1, text.size(), plain_);
    if (written != text.size()) Fail();
  }

  void Close() {
    if (!CloseFile()) Fail();
  }

 private:
  bool CloseFile() {
    bool good = true;
    if (gzip_ != nullptr) good = gzclose(gzip_) == Z_OK;
    if (plain_ != nullptr) good = std::fclose(plain_) == 0;
    gzip_ = nullptr;
    plain_ = nullptr;
    return good;
  }

  [[noreturn]] void Fail() const {
    throw std::runtime_error(path_ + ": cannot be written" +
                             (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
  }

  std::string path_;
  gzFile gzip_ = nullptr;
  std::FILE* plain_ = nullptr;
};

class CarmenWriter final : public LogSink {
 public:
  CarmenWriter(const std::string& path, int range_decimals)
      : sink_(path), range_decimals_(std::clamp(range_decimals, 1, 9)) {}

  void Write(const Observation& observation) override {
    std::visit([this](const auto& reading) { WriteReading(reading); }, observation);
    FlushWhenFull();
  }

  void WriteCloud(const CloudReading&) override {
    throw InputError("a text log has no word for clouds; write them to a .bag or .mcap");
  }

  void WriteComment(const std::string& text) override {
    Append("# ");
    for (const char c : text) text_.push_back(c == '\n' || c == '\r' ? ' ' : c);
    text_.push_back('\n');
    FlushWhenFull();
  }

  void Close() override {
    if (closed_) return;
    closed_ = true;
    sink_.Write(text_);
    text_.clear();
    sink_.Close();
  }

 private:
  void WriteReading(const OdometryReading& reading) {
    T_odom_robot_ = reading.T_odom_robot;
    Append("ODOM");
    Append(reading.T_odom_robot);
    Append(" 0 0 0");
    EndLine(reading.stamp);
  }

  void WriteReading(const PressureReading& reading) {
    Append("PRESSURE");
    Append(reading.pressure_pa, 3);
    EndLine(reading.stamp);
  }

  void WriteReading(const AccelerationReading& reading) {
    Append("ACCEL");
    for (int axis = 0; axis < 3; ++axis) {
      Append(reading.acceleration_in_robot(axis), kPoseDecimals);
    }
    EndLine(reading.stamp);
  }

  void WriteReading(const FloorLabel& reading) {
    if (!IsFloorLabel(reading.label)) {
      throw std::invalid_argument("floor label '" + reading.label + "' cannot be written");
    }
    Append("FLOOR ");
    Append(reading.label);
    EndLine(reading.stamp);
  }

  void WriteReading(const LaserScan& scan) {
    if (scan.ranges.empty()) throw std::invalid_argument("a scan without beams cannot be written");
    if (scan.T_odom_robot) T_odom_robot_ = *scan.T_odom_robot;
    if (FlaserCanSay(scan)) {
      WriteFlaser(scan);
    } else {
      WriteRobotLaser(scan);
    }
  }

  /// FLASER beams span 180 degrees, and the limit is one for the whole log.
  bool FlaserCanSay(const LaserScan& scan) const {
    const BeamGeometry geometry = FlaserGeometry(scan.size(), kPi);
    constexpr double kSame = 1e-9;
    return scan.size() > 1 && std::abs(geometry.first_angle - scan.first_angle) < kSame &&
           std::abs(geometry.angle_step - scan.angle_step) < kSame &&
           std::isfinite(scan.max_range) && (!flaser_limit_ || *flaser_limit_ == scan.max_range);
  }

  void WriteFlaser(const LaserScan& scan) {
    if (!flaser_limit_) {
      flaser_limit_ = scan.max_range;
      Append("PARAM robot_front_laser_max");
      Append(scan.max_range, range_decimals_);
      EndLine(scan.stamp);
    }
    Append("FLASER ");
    Append(std::to_string(scan.size()));
    for (const float range : scan.ranges) AppendRange(range, scan.max_range);
    Append(T_odom_robot_ * scan.T_robot_laser);
    Append(T_odom_robot_);
    EndLine(scan.stamp);
  }

  void WriteRobotLaser(const LaserScan& scan) {
    const bool mirrored = scan.angle_step < 0.0;
    const double first = mirrored ? scan.Angle(scan.size() - 1) : scan.first_angle;
    const double step = std::abs(scan.angle_step);
    Append("ROBOTLASER1 0");
    Append(first, kAngleDecimals);
    Append(step * static_cast<double>(scan.size() - 1), kAngleDecimals);
    Append(step, kAngleDecimals);
    Append(std::isfinite(scan.max_range) ? scan.max_range : 0.0, range_decimals_);
    Append(" 0.01 0 ");
    Append(std::to_string(scan.size()));
    for (std::size_t i = 0; i < scan.size(); ++i) {
      AppendRange(scan.ranges[mirrored ? scan.size() - 1 - i : i], scan.max_range);
    }
    Append(" 0");
    Append(T_odom_robot_ * scan.T_robot_laser);
    Append(T_odom_robot_);
    Append(" 0 0 0 0 0");
    EndLine(scan.stamp);
  }

  /// A hit just below the limit must not be rounded up to it.
  void AppendRange(float range, float max_range) {
    if (std::isnan(range)) {
      Append(" 0");
    } else if (!(range < max_range)) {
      Append(max_range, range_decimals_);
    } else {
      const double smallest_step = std::pow(10.0, -range_decimals_);
      Append(std::min<double>(range, max_range - smallest_step), range_decimals_);
    }
  }

  void Append(std::string_view text) { text_.append(text); }

  void Append(const Pose2& pose) {
    Append(pose.x, kPoseDecimals);
    Append(pose.y, kPoseDecimals);
    Append(pose.theta, kPoseDecimals);
  }

  /// A space and the number; as std::to_chars writes it, so independent of the locale.
  void Append(double value, int decimals) {
    char digits[400];
    const auto [end, error] =
        std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::fixed, decimals);
    text_.push_back(' ');
    text_.append(digits, error == std::errc() ? static_cast<std::size_t>(end - digits) : 0);
  }

  void EndLine(double stamp) {
    Append(stamp, kPoseDecimals);
    text_.push_back(' ');
    Append(kHost);
    Append(stamp, kPoseDecimals);
    text_.push_back('\n');
  }

  void FlushWhenFull() {
    if (text_.size() < kBufferSize) return;
    sink_.Write(text_);
    text_.clear();
  }

  TextSink sink_;
  int range_decimals_;
  std::string text_;
  bool closed_ = false;
  Pose2 T_odom_robot_;
  std::optional<float> flaser_limit_;
};

std::unique_ptr<LogSink> MakeSink(const std::string& path, int range_decimals) {
  if (HasEnding(path, ".bag")) return MakeRosLogWriter(CreateRos1Bag(path));
  if (HasEnding(path, ".mcap")) return MakeRosLogWriter(CreateMcap(path));
  return std::make_unique<CarmenWriter>(path, range_decimals);
}

}  // namespace

LogWriter::LogWriter(const std::string& path, int range_decimals)
    : sink_(MakeSink(path, range_decimals)) {}
LogWriter::~LogWriter() {
  try {
    sink_->Close();
  } catch (const std::exception&) {
    // Whoever wants to know calls Close().
  }
}

void LogWriter::Write(const Observation& observation) { sink_->Write(observation); }
void LogWriter::WriteCloud(const CloudReading& cloud) { sink_->WriteCloud(cloud); }
void LogWriter::WriteComment(const std::string& text) { sink_->WriteComment(text); }
void LogWriter::Close() { sink_->Close(); }

}  // namespace masked_mapper
