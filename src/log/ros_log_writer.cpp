// SPDX-License-Identifier: BSD-3-Clause
#include "ros_log_writer.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "masked_mapper/text/input_error.hpp"
#include "ros_fields.hpp"
#include "ros_message_writing.hpp"

namespace masked_mapper {
namespace {

constexpr const char* kOdometryFrame = "odom";
constexpr const char* kRobotFrame = "base_link";
constexpr const char* kLaserFrame = "laser";
constexpr const char* kLidarFrame = "lidar";

Eigen::Isometry3d InSpace(const Pose2& pose) {
  Eigen::Isometry3d transform(Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ()));
  transform.translation() = Eigen::Vector3d(pose.x, pose.y, 0.0);
  return transform;
}

// To the digits of a text log: the same drive is then the same in every kind of log.
double Rounded(double value, double steps) { return std::round(value * steps) / steps; }
constexpr double kMicro = 1e6;
constexpr double kMilli = 1e3;

class RosLogWriter final : public LogSink {
 public:
  explicit RosLogWriter(std::unique_ptr<BagWriter> bag) : bag_(std::move(bag)) {}

  void Write(const Observation& observation) override {
    std::visit([this](const auto& reading) { WriteReading(reading); }, observation);
  }
  void WriteCloud(const CloudReading& cloud) override {
    if (!has_lidar_mount_) {
      has_lidar_mount_ = true;
      const RosTransform mount{{cloud.stamp, kRobotFrame}, kLidarFrame, cloud.T_robot_lidar};
      Put("/tf_static", TopicKind::kTransforms, cloud.stamp,
          WriteTransforms({mount}, bag_->Encoding()));
    }
    if (cloud.T_odom_robot) WriteOdometryAt(cloud.stamp, *cloud.T_odom_robot);
    const RosPointCloud message{{cloud.stamp, kLidarFrame}, cloud.points, true};
    Put("/points", TopicKind::kCloud, cloud.stamp,
        WritePointCloud(message, cloud.layout, bag_->Encoding()));
  }
  void WriteComment(const std::string&) override {}
  void Close() override {
    if (!closed_) bag_->Close();
    closed_ = true;
  }

 private:
  void WriteReading(const OdometryReading& reading) {
    WriteOdometryAt(reading.stamp, reading.T_odom_robot);
  }

  void WriteReading(const PressureReading& reading) {
    const RosFluidPressure pressure{{reading.stamp, kRobotFrame},
                                    Rounded(reading.pressure_pa, kMilli)};
    Put("/pressure", TopicKind::kPressure, reading.stamp,
        WriteFluidPressure(pressure, bag_->Encoding()));
  }

  void WriteReading(const AccelerationReading& reading) {
    const RosImu imu{{reading.stamp, kRobotFrame},
                     reading.acceleration_in_robot.unaryExpr(
                         [](double value) { return Rounded(value, kMicro); })};
    Put("/imu", TopicKind::kImu, reading.stamp, WriteImu(imu, bag_->Encoding()));
  }

  void WriteReading(const FloorLabel&) {
    throw InputError("a bag has no word for floor labels; write them to a .log");
  }

  void WriteReading(const LaserScan& scan) {
    if (!T_robot_laser_ || T_robot_laser_->AsVector() != scan.T_robot_laser.AsVector()) {
      T_robot_laser_ = scan.T_robot_laser;
      const RosTransform mount{{scan.stamp, kRobotFrame}, kLaserFrame, InSpace(scan.T_robot_laser)};
      Put("/tf_static", TopicKind::kTransforms, scan.stamp,
          WriteTransforms({mount}, bag_->Encoding()));
    }
    if (scan.T_odom_robot) WriteOdometryAt(scan.stamp, *scan.T_odom_robot);
    RosLaserScan ros_scan;
    ros_scan.header = {scan.stamp, kLaserFrame};
    ros_scan.angle_min = scan.first_angle;
    ros_scan.angle_increment = scan.angle_step;
    ros_scan.time_increment = scan.beam_time;
    ros_scan.range_max = scan.max_range;
    ros_scan.ranges = scan.ranges;
    Put("/scan", TopicKind::kScan, scan.stamp, WriteLaserScan(ros_scan, bag_->Encoding()));
  }

  void WriteOdometryAt(double stamp, const Pose2& T_odom_robot) {
    const Eigen::Isometry3d in_space =
        InSpace({Rounded(T_odom_robot.x, kMicro), Rounded(T_odom_robot.y, kMicro),
                 Rounded(T_odom_robot.theta, kMicro)});
    const RosHeader header{stamp, kOdometryFrame};
    Put("/odom", TopicKind::kOdometry, stamp,
        WriteOdometry({header, kRobotFrame, in_space}, bag_->Encoding()));
    Put("/tf", TopicKind::kTransforms, stamp,
        WriteTransforms({{header, kRobotFrame, in_space}}, bag_->Encoding()));
  }

  void Put(const std::string& topic, TopicKind kind, double stamp, const std::string& message) {
    auto known = topics_.find(topic);
    if (known == topics_.end()) {
      known = topics_.emplace(topic, bag_->AddTopic(topic, TypeOfKind(kind))).first;
    }
    bag_->Write(known->second, NanosecondsOf(stamp), message);
  }

  std::unique_ptr<BagWriter> bag_;
  std::map<std::string, std::uint16_t> topics_;
  std::optional<Pose2> T_robot_laser_;
  bool has_lidar_mount_ = false;
  bool closed_ = false;
};

}  // namespace

std::unique_ptr<LogSink> MakeRosLogWriter(std::unique_ptr<BagWriter> bag) {
  return std::make_unique<RosLogWriter>(std::move(bag));
}

}  // namespace masked_mapper
