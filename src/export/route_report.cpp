// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/map_export.hpp"

#include "report.hpp"

namespace masked_mapper {

void WriteRouteReport(const BuildingMap& map, const RunDescription& run,
                      const std::vector<OccupancyGrid>& grids, double max_range_m,
                      const Route& route, const std::filesystem::path& path) {
  WriteReport(ReportData(map, grids, max_range_m, &route), Summarise(map, run, grids), path);
}

}  // namespace masked_mapper
