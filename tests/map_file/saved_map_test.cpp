// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/saved_map.hpp"

#include <gtest/gtest.h>

#include "masked_mapper/options/option_table.hpp"

namespace masked_mapper {
namespace {

TEST(SavedMap, ChangedOptionsAreThoseThatDiffer) {
  Options options;
  EXPECT_TRUE(ChangedOptions(options).empty());
  options.threads = 7;
  SetOption("matcher.min_score=0.5", options);
  SetOption("grid.resolution_m=0.1", options);
  EXPECT_EQ(ChangedOptions(options),
            (NamedValues{{"matcher.min_score", "0.5"}, {"grid.resolution_m", "0.1"}}));
}

TEST(SavedMap, DifferencesAreSaidInWords) {
  const MapOrigin before{"a.log", "openings", {}};
  MapOrigin now = before;
  EXPECT_EQ(DifferenceFrom(before, now), "");
  now.options.mapping.closures.matcher.min_score = 0.5;
  EXPECT_EQ(DifferenceFrom(before, now), "matcher.min_score was 0.425, now it is 0.5");
  now = before;
  now.onto = "old";
  EXPECT_EQ(DifferenceFrom(before, now), "--onto was not known, now it is old");
  EXPECT_EQ(DifferenceFrom(now, before), "--onto was old, now there is none");
}

// The finished map is drawn anew with others.
TEST(SavedMap, OptionsOfDrawingMakeNoOtherMap) {
  const MapOrigin before{"a.log", "openings", {}};
  MapOrigin now = before;
  SetOption("grid.resolution_m=0.1", now.options);
  SetOption("octree.wall_height_m=1", now.options);
  now.options.threads = 7;
  EXPECT_EQ(DifferenceFrom(before, now), "");
}

}  // namespace
}  // namespace masked_mapper
