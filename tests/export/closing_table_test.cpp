// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/summary_file.hpp"

#include <gtest/gtest.h>

#include "export/sample_map.hpp"

namespace masked_mapper {
namespace {

TEST(ClosingTable, SaysWhatWasDone) {
  Summary summary = Summarise(SampleMap(), {"a.log", "openings", {}}, {{}, {}});
  summary.peak_memory_mib = 123.4;
  summary.floors[0].area_m2 = 987.6;
  const std::string table = ClosingTable(summary);
  for (const char* expected :
       {"  attempted             5  pairs offered to the matcher\n", "  validated             1\n",
        "          2  score below the minimum\n",
        "  floor 0             988  m2, at 0.00 m, 3 nodes\n", "at -3.50 m (assumed), 1 nodes\n",
        "  read              0.500  s\n", "  peak memory         123  MiB\n"}) {
    EXPECT_NE(table.find(expected), std::string::npos) << "missing: " << expected << "in\n"
                                                       << table;
  }
}

TEST(ClosingTable, LongLabelsDoNotBreakIt) {
  Summary summary;
  summary.floors.push_back({std::string(40, 'x'), 0.0, true, 1, 1.0});
  EXPECT_NE(ClosingTable(summary).find(std::string(40, 'x')), std::string::npos);
}

}  // namespace
}  // namespace masked_mapper
