// SPDX-License-Identifier: BSD-3-Clause
#include "log/ros_point_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "log/cloud_bytes.hpp"
#include "log/ros2_bag_writing.hpp"

namespace masked_mapper {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::optional<RosPointCloud> Parsed(const std::string& bytes) {
  return ParsePointCloud(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

std::string Fault(const CloudBytes& cloud) {
  const std::string bytes = cloud.Ros1();
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  EXPECT_FALSE(ParsePointCloud(data, bytes.size()));
  return FaultOfPointCloud(data, bytes.size());
}

struct Layout {
  const char* name;
  std::vector<CloudField> fields;  ///< x, y, z, intensity, time
  std::uint32_t step;
  double time_of_second;  ///< what the field says 0.05 s after the stamp, per
  double time_at_stamp;
};

class LayoutTest : public ::testing::TestWithParam<Layout> {};

TEST_P(LayoutTest, IsRead) {
  const Layout& layout = GetParam();
  const auto time = [&](double s) { return layout.time_at_stamp + layout.time_of_second * s; };
  CloudBytes cloud = CloudOf(layout.fields, layout.step,
                             {{1.0, -2.0, 3.0, 10.0, time(0.0)},
                              {0.0, 0.0, 0.0, 0.0, time(0.02)},
                              {4.0, 5.0, -6.0, 250.0, time(0.1)}});
  cloud.stamp = 1700000000.0;
  const auto parsed = Parsed(cloud.Ros1());
  ASSERT_TRUE(parsed);
  ASSERT_EQ(parsed->points.size(), 2U);  // no return at the origin
  EXPECT_EQ(parsed->points[0].position, Eigen::Vector3f(1.0F, -2.0F, 3.0F));
  EXPECT_EQ(parsed->points[1].position, Eigen::Vector3f(4.0F, 5.0F, -6.0F));
  EXPECT_EQ(parsed->points[1].intensity, 250.0F);
  ASSERT_TRUE(parsed->has_times);
  EXPECT_NEAR(parsed->points[0].time, 0.0, 1e-5);
  EXPECT_NEAR(parsed->points[1].time, 0.1, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Drivers, LayoutTest,
    ::testing::Values(
        Layout{"velodyne",
               {{"x", 0}, {"y", 4}, {"z", 8}, {"intensity", 12}, {"time", 18}},
               22,
               1.0,
               0.0},
        Layout{"ouster",
               {{"x", 0}, {"y", 4}, {"z", 8}, {"intensity", 16}, {"t", 20, 6}},
               48,
               1e9,
               0.0},
        Layout{"hesai",
               {{"x", 0}, {"y", 4}, {"z", 8}, {"intensity", 16}, {"timestamp", 24, 8}},
               48,
               1.0,
               1700000000.0},
        Layout{"livox",
               {{"x", 0}, {"y", 4}, {"z", 8}, {"intensity", 12}, {"timestamp", 18, 8}},
               26,
               1e9,
               1700000000e9},
        Layout{"livox_custom",
               {{"x", 0}, {"y", 4}, {"z", 8}, {"reflectivity", 12, 2}, {"offset_time", 13, 6}},
               17,
               1e9,
               0.0},
        Layout{"doubles_backwards",
               {{"x", 24, 8}, {"y", 16, 8}, {"z", 8, 8}, {"intensity", 4, 4}, {"t", 0, 6}},
               32,
               1e6,
               0.0},
        Layout{"another_clock",
               {{"x", 0, 3}, {"y", 2, 3}, {"z", 4, 3}, {"intensity", 6, 2}, {"timestamp", 8, 8}},
               16,
               1e6,
               86400e6 * 3.0}),
    [](const auto& info) { return info.param.name; });

const std::vector<CloudField> kPlain = {{"x", 0}, {"y", 4}, {"z", 8}};

CloudBytes Plain(std::size_t points) {
  return CloudOf(kPlain, 12, std::vector<std::vector<double>>(points, {1.0, 2.0, 3.0}));
}

TEST(RosPointCloudTest, PointsThatAreNoReturnsAreLeftOut) {
  const CloudBytes cloud =
      CloudOf(kPlain, 16,
              {{kNan, kNan, kNan}, {1.0, kNan, 0.0}, {0.0, 0.0, 0.0}, {1e9, 0.0, 0.0}, {1, 1, 1}});
  const auto parsed = Parsed(cloud.Ros1());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->points.size(), 1U);
  EXPECT_FALSE(parsed->has_times);
}

TEST(RosPointCloudTest, AnOrganisedCloudMayHavePaddedRows) {
  CloudBytes cloud = Plain(6);
  cloud.height = 2;
  cloud.width = 2;
  cloud.row_step = 36;
  cloud.data.resize(72);
  const auto parsed = Parsed(cloud.Ros1());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->points.size(), 4U);
}

TEST(RosPointCloudTest, BigEndianNumbersAreTurned) {
  CloudBytes cloud = Plain(1);
  cloud.is_bigendian = true;
  for (std::size_t i = 0; i < 12; i += 4) {
    std::reverse(cloud.data.begin() + static_cast<std::ptrdiff_t>(i),
                 cloud.data.begin() + static_cast<std::ptrdiff_t>(i + 4));
  }
  const auto parsed = Parsed(cloud.Ros1());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->points.at(0).position, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
}

TEST(RosPointCloudTest, OfRos2IsTheSame) {
  const CloudBytes cloud = Plain(3);
  const std::string bytes = CdrBytes([&cloud](Cdr& cdr) {
    PutHeader(cdr, 100, "lidar");
    cdr << cloud.height << cloud.width << static_cast<std::uint32_t>(cloud.fields.size());
    for (const CloudField& field : cloud.fields) {
      cdr << field.name << field.offset << field.type << field.count;
    }
    cdr << false << cloud.point_step << cloud.row_step;
    cdr << std::vector<std::uint8_t>(cloud.data.begin(), cloud.data.end()) << true;
  });
  const auto parsed = ParsePointCloud(reinterpret_cast<const unsigned char*>(bytes.data()),
                                      bytes.size(), MessageEncoding::kCdr);
  ASSERT_TRUE(parsed);
  ASSERT_EQ(parsed->points.size(), 3U);
  EXPECT_EQ(parsed->points[2].position, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(ParsePointCloud(reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                 MessageEncoding::kCdr));
  }
}

TEST(RosPointCloudTest, WhatDoesNotFitIsNamed) {
  constexpr auto kMost = std::numeric_limits<std::uint32_t>::max();
  CloudBytes cloud = Plain(4);
  cloud.width = 5;
  cloud.row_step = 60;
  EXPECT_EQ(Fault(cloud), "holds 48 bytes of points where 60 were expected");
  cloud = Plain(4);
  cloud.width = kMost;
  cloud.height = kMost;
  EXPECT_NE(Fault(cloud).find("more than"), std::string::npos);
  cloud = Plain(4);
  cloud.fields[1].offset = kMost;
  EXPECT_EQ(Fault(cloud), "has the field `y` at byte 4294967295 of points of 12 bytes");
  cloud = Plain(4);
  cloud.fields[2].offset = 9;
  EXPECT_EQ(Fault(cloud), "has the field `z` at byte 9 of points of 12 bytes");
  cloud = Plain(4);
  cloud.point_step = kMost;
  EXPECT_FALSE(Fault(cloud).empty());
  cloud = Plain(4);
  cloud.point_step = 0;
  EXPECT_FALSE(Fault(cloud).empty());
  cloud = Plain(4);
  cloud.height = 2;
  cloud.width = 2;
  cloud.row_step = kMost;
  EXPECT_FALSE(Fault(cloud).empty());
  cloud.row_step = 1;
  EXPECT_EQ(Fault(cloud), "has rows of 1 bytes for 2 points of 12");
  cloud = Plain(4);
  cloud.fields[0].name = "distance";
  EXPECT_EQ(Fault(cloud), "has no field `x`");
  cloud = Plain(4);
  cloud.fields[0].type = 200;
  EXPECT_EQ(Fault(cloud), "has the field `x` of type 200, expected 1 to 8");
}

TEST(RosPointCloudTest, AnEmptyCloudIsOne) {
  CloudBytes cloud = Plain(0);
  ASSERT_TRUE(Parsed(cloud.Ros1()));
  EXPECT_TRUE(Parsed(cloud.Ros1())->points.empty());
  cloud.height = 0xffffffffU;  // rows of nothing, which take no time
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Parsed(cloud.Ros1()));
}

TEST(RosPointCloudTest, ACutMessageIsNone) {
  const std::string bytes = Plain(3).Ros1();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(Parsed(bytes.substr(0, size))) << size;
  }
}

}  // namespace
}  // namespace masked_mapper
