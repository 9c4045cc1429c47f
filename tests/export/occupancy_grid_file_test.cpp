// SPDX-License-Identifier: BSD-3-Clause
#include "export/occupancy_grid_file.hpp"

#include <gtest/gtest.h>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(OccupancyGridFile, PictureHasTheTopRowFirst) {
  OccupancyGrid grid;
  grid.origin_x = -1.25;
  grid.origin_y = 245 * 0.05;  // not 12.25 to the last bit
  grid.width = 3;
  grid.height = 2;
  grid.cells = {Cell::kFree,    Cell::kOccupied, Cell::kUnknown,
                Cell::kUnknown, Cell::kUnknown,  Cell::kOccupied};
  const TestFolder folder;
  WriteOccupancyGrid(grid, folder / "2.5");
  EXPECT_EQ(ReadBytes(folder / "2.5.pgm"),
            std::string("P5\n3 2\n255\n") + std::string("\xCD\xCD\x00\xFE\x00\xCD", 6));
  EXPECT_EQ(ReadBytes(folder / "2.5.yaml"),
            "image: 2.5.pgm\nresolution: 0.05\norigin: [-1.250000, 12.250000, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n");
}

TEST(OccupancyGridFile, ThresholdsTellTheThreeApart) {
  // map_server: p = (255 - grey) / 255; occupied above 0.65, free below 0.196.
  EXPECT_LT((255 - 254) / 255.0, 0.196);
  EXPECT_GT((255 - 0) / 255.0, 0.65);
  EXPECT_GT((255 - 205) / 255.0, 0.196);
  EXPECT_LT((255 - 205) / 255.0, 0.65);
}

TEST(OccupancyGridFile, EmptyGridIsOneUnknownCell) {
  const TestFolder folder;
  WriteOccupancyGrid({}, folder / "0");
  EXPECT_EQ(ReadBytes(folder / "0.pgm"), "P5\n1 1\n255\n\xCD");
}

}  // namespace
}  // namespace masked_mapper
