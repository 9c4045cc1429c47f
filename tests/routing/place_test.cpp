// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/routing/route.hpp"

#include <gtest/gtest.h>

#include "masked_mapper/text/input_error.hpp"
#include "routing/two_floors.hpp"

namespace masked_mapper {
namespace {

TEST(Place, ByCoordinatesStampOrName) {
  BuildingMap map = TwoFloors();
  map.places.push_back({"dock", 1, {1.0, -2.5}});
  EXPECT_EQ(PlaceOf("-1,3,+4.5", map).floor, 1);
  EXPECT_EQ(PlaceOf("-1,3,+4.5", map).at_in_world, Eigen::Vector2d(3.0, 4.5));
  EXPECT_EQ(PlaceOf("roof,-3e0,4", map).at_in_world.x(), -3.0);
  EXPECT_EQ(PlaceOf("t=0.9", map).at_in_world, Eigen::Vector2d(3.55, 1.65));
  EXPECT_EQ(PlaceOf("t=5", map).floor, 1);
  EXPECT_EQ(PlaceOf("dock", map).at_in_world, Eigen::Vector2d(1.0, -2.5));
}

TEST(Place, SaysWhatIsWrong) {
  BuildingMap map = TwoFloors();
  map.places.push_back({"dock", 1, {1.0, -2.5}});
  for (const char* wrong : {"", "0", "0,1", "0,1,2,3", "0,x,1", "0,nan,1", "0,1e9,1", ",1,2",
                            "2,1,1", "t=", "t=1e", "t=nan", "t=99", "t=3.4", "dok"}) {
    EXPECT_THROW(PlaceOf(wrong, map), InputError) << wrong;
  }
  try {
    PlaceOf("dok", map);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("dock"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace masked_mapper
