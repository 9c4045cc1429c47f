// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/saved_map.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(MapFileWriter, SameMapSameBytesWhateverTimeItTook) {
  const TestFolder folder;
  BuildingMap map = SampleMap();
  WriteMapFile({"drive.log", "openings", {}}, map, folder / "a.mmap");
  map.seconds.total = 77.0;
  MapOrigin origin{"drive.log", "openings", {}};
  origin.options.threads = 7;
  WriteMapFile(origin, map, folder / "b.mmap");
  EXPECT_EQ(ReadBytes(folder / "a.mmap"), ReadBytes(folder / "b.mmap"));
  // One file, nothing beside it.
  EXPECT_EQ(FilesBelow(folder.path()), (std::vector<std::string>{"a.mmap", "b.mmap"}));
}

TEST(MapFileWriter, SaysWhatItCannotWrite) {
  const TestFolder folder;
  EXPECT_THROW(WriteMapFile({}, SampleMap(), folder / "missing/a.mmap"), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
