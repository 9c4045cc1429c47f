// SPDX-License-Identifier: BSD-3-Clause
#include "log/ros_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "log/bag_bytes.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

template <typename Parse>
auto On(const Parse& parse, const std::string& bytes) {
  return parse(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
               MessageEncoding::kRos1);
}

std::string PoseBytes(double x, double y, double yaw) {
  std::string bytes;
  for (const double value : {x, y, 0.5, 0.0, 0.0, std::sin(yaw / 2), std::cos(yaw / 2)}) {
    bytes += Raw(value);
  }
  return bytes;
}

TEST(RosMessagesTest, ReadsALaserScan) {
  const auto scan = On(ParseLaserScan, LaserScanBytes(9, 5));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header.stamp, 9.0);
  EXPECT_EQ(scan->header.frame_id, "laser");
  EXPECT_EQ(scan->ranges, (std::vector<float>{1, 2, 3, 4, 5}));
  EXPECT_EQ(scan->range_max, 30.0);
  EXPECT_NEAR(scan->angle_increment, 0.4, 1e-6);
}

TEST(RosMessagesTest, AnglesAreTheDegreesThatWereMeant) {
  const auto angles = [](float first, float step) {
    std::string scan = LaserScanBytes(9, 5);
    const std::size_t at = RosHeaderBytes(9, "/laser").size();
    scan.replace(at, 4, Raw(first));
    scan.replace(at + 8, 4, Raw(step));
    const auto parsed = On(ParseLaserScan, scan);
    EXPECT_TRUE(parsed);
    return std::pair{parsed->angle_min, parsed->angle_increment};
  };
  const auto meant = angles(static_cast<float>(DegToRad(-90.0)), static_cast<float>(DegToRad(0.5)));
  EXPECT_EQ(meant.first, DegToRad(-90.0));
  EXPECT_EQ(meant.second, DegToRad(0.5));
  const auto odd = angles(-1.2345678F, 0.0061234567F);
  EXPECT_EQ(odd.first, static_cast<double>(-1.2345678F));
  EXPECT_EQ(odd.second, static_cast<double>(0.0061234567F));
}

TEST(RosMessagesTest, ACutMessageIsNone) {
  const std::string scan = LaserScanBytes(9, 5);
  for (std::size_t length = 0; length < scan.size(); ++length) {
    EXPECT_FALSE(On(ParseLaserScan, scan.substr(0, length))) << length;
  }
}

TEST(RosMessagesTest, AHostileCountAllocatesNothing) {
  std::string scan = LaserScanBytes(9, 5);
  const std::size_t count_at = RosHeaderBytes(9, "/laser").size() + 28;
  scan.replace(count_at, 4, Raw(std::uint32_t{0xffffffff}));
  EXPECT_FALSE(On(ParseLaserScan, scan));
  EXPECT_FALSE(On(
      [](const unsigned char* data, std::size_t size, MessageEncoding /*encoding*/) {
        return ParseMultiEchoLaserScan(data, size, EchoChoice::kFirst);
      },
      scan));
  EXPECT_FALSE(On(ParseTransforms, Raw(std::uint32_t{0xffffffff}) + std::string(200, '\0')));
  std::string long_frame = Raw(std::uint32_t{0}) + Raw(std::uint32_t{0}) + Raw(std::uint32_t{0}) +
                           Raw(std::uint32_t{0xfffffff0}) + "x";
  EXPECT_FALSE(On(ParseHeader, long_frame));
}

TEST(RosMessagesTest, ReadsOdometryAndTransforms) {
  const auto odometry = On(
      ParseOdometry, RosHeaderBytes(3, "odom") + WithLength("/base_link") + PoseBytes(1, 2, 0.7));
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->child_frame_id, "base_link");
  EXPECT_NEAR(odometry->T_frame_child.translation().y(), 2.0, 1e-12);
  EXPECT_NEAR(
      std::atan2(odometry->T_frame_child.linear()(1, 0), odometry->T_frame_child.linear()(0, 0)),
      0.7, 1e-12);
  const auto transforms =
      On(ParseTransforms, Raw(std::uint32_t{2}) + RosHeaderBytes(3, "a") + WithLength("b") +
                              PoseBytes(1, 2, 0.7) + RosHeaderBytes(3, "b") + WithLength("c") +
                              PoseBytes(3, 4, 0.0));
  ASSERT_TRUE(transforms);
  ASSERT_EQ(transforms->size(), 2U);
  EXPECT_EQ((*transforms)[1].child_frame_id, "c");
}

TEST(RosMessagesTest, RefusesWhatIsNoPose) {
  const std::string header = RosHeaderBytes(3, "odom") + WithLength("base");
  EXPECT_FALSE(On(ParseOdometry, header + std::string(56, '\0')));  // a quaternion of zeros
  EXPECT_FALSE(On(ParseOdometry, header + PoseBytes(std::nan(""), 0, 0)));
  EXPECT_FALSE(On(ParseOdometry, header + PoseBytes(1e300, 0, 0)));
}

TEST(RosMessagesTest, ReadsImuAndPressure) {
  std::string imu = RosHeaderBytes(3, "imu") + std::string(13 * 8 + 12 * 8, '\0');
  imu += Raw(1.0) + Raw(2.0) + Raw(9.81) + std::string(72, '\0');
  const auto parsed = On(ParseImu, imu);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->acceleration, Eigen::Vector3d(1.0, 2.0, 9.81));
  const auto pressure = On(ParseFluidPressure, RosHeaderBytes(3, "") + Raw(101325.0) + Raw(0.0));
  ASSERT_TRUE(pressure);
  EXPECT_EQ(pressure->pressure_pa, 101325.0);
}

TEST(RosMessagesTest, ChoosesTheEcho) {
  std::string bytes = RosHeaderBytes(9, "laser");
  for (const float value : {-1.0F, 1.0F, 1.0F, 0.0F, 0.0F, 0.1F, 30.0F}) bytes += Raw(value);
  bytes += Raw(std::uint32_t{2});
  bytes += Raw(std::uint32_t{2}) + Raw(3.0F) + Raw(5.0F) + Raw(std::uint32_t{0});
  bytes += Raw(std::uint32_t{2});
  bytes += Raw(std::uint32_t{2}) + Raw(10.0F) + Raw(90.0F) + Raw(std::uint32_t{0});
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto first = ParseMultiEchoLaserScan(data, bytes.size(), EchoChoice::kFirst);
  const auto strongest = ParseMultiEchoLaserScan(data, bytes.size(), EchoChoice::kStrongest);
  ASSERT_TRUE(first && strongest);
  EXPECT_EQ(first->ranges[0], 3.0F);
  EXPECT_EQ(strongest->ranges[0], 5.0F);
  EXPECT_TRUE(std::isnan(first->ranges[1]));
}

}  // namespace
}  // namespace masked_mapper
