// SPDX-License-Identifier: BSD-3-Clause
#include "export/las_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace masked_mapper {
namespace {

// Read by the offsets that the specification's tables state, not by the writer's order.
template <typename T>
T At(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

std::string Written(const std::vector<SpacePoint>& points) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("masked_mapper_las_" + std::to_string(::getpid()) + ".las");
  WriteLas(points, {{10, 20, 30}, {255, 0, 128}}, path);
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  std::filesystem::remove(path);
  return bytes.str();
}

TEST(LasFileTest, IsVersionOnePointFourOfFormatSeven) {
  SpacePoint a;
  a.position = {1.2345, -2.0, 3.0};
  a.intensity = 100.0F;
  a.stamp = 1700000000.25;
  SpacePoint b;
  b.position = {-7.0, 8.0, -9.001};
  b.label = 1;
  const std::string bytes = Written({a, b});
  ASSERT_EQ(bytes.size(), 375U + 2U * 36U);
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(At<std::uint8_t>(bytes, 24), 1);
  EXPECT_EQ(At<std::uint8_t>(bytes, 25), 4);
  EXPECT_EQ(At<std::uint16_t>(bytes, 94), 375);   // header
  EXPECT_EQ(At<std::uint32_t>(bytes, 96), 375U);  // points
  EXPECT_EQ(At<std::uint8_t>(bytes, 104), 7);     // format
  EXPECT_EQ(At<std::uint16_t>(bytes, 105), 36);   // of each
  EXPECT_EQ(At<std::uint32_t>(bytes, 107), 0U);   // must be 0 of this format
  EXPECT_EQ(At<std::uint64_t>(bytes, 247), 2U);
  EXPECT_EQ(At<std::uint64_t>(bytes, 255), 2U);
  EXPECT_NEAR(At<double>(bytes, 179), 1.2345, 6e-4);  // max x, then min x
  EXPECT_NEAR(At<double>(bytes, 187), -7.0, 1e-9);
  EXPECT_NEAR(At<double>(bytes, 219), -9.001, 1e-9);  // min z
  const double scale = At<double>(bytes, 131);
  EXPECT_NEAR(scale * At<std::int32_t>(bytes, 375), 1.2345, 6e-4);
  EXPECT_NEAR(scale * At<std::int32_t>(bytes, 379), -2.0, 1e-9);
  EXPECT_EQ(At<std::uint16_t>(bytes, 375 + 12), 25600);
  EXPECT_EQ(At<std::uint8_t>(bytes, 375 + 14), 0x11);
  EXPECT_EQ(At<std::uint16_t>(bytes, 375 + 20), 1);       // floor
  EXPECT_EQ(At<std::uint16_t>(bytes, 375 + 36 + 20), 2);  // the other
  // 2023-11-14 22:13:20.25 UTC in GPS time: 18 leap seconds on, 315964800 s after 1970, less 1e9.
  EXPECT_NEAR(At<double>(bytes, 375 + 22), 1384035218.25 - 1e9, 1e-6);
  EXPECT_EQ(At<std::uint16_t>(bytes, 375 + 36 + 30), 255 * 257);
}

TEST(LasFileTest, OfNothingIsAHeader) { EXPECT_EQ(Written({}).size(), 375U); }

}  // namespace
}  // namespace masked_mapper
