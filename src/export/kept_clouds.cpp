// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/space_export.hpp"

#include <optional>
#include <string>

#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

void ForEachKeptCloud(const BuildingMap& map, std::size_t stride,
                      const std::function<void(const LevelledCloud&, std::size_t)>& take) {
  for (std::size_t i = 0; i < map.kept_clouds.size(); i += stride) {
    const KeptCloud& kept = map.kept_clouds[i];
    std::optional<LevelledCloud> cloud = UnpackCloud(*kept.packed);
    if (!cloud) throw InputError("cloud " + std::to_string(i) + " of the map is damaged");
    cloud->log_stamp = map.trajectory[kept.trajectory_index].log_stamp;
    take(*cloud, kept.trajectory_index);
  }
}

}  // namespace masked_mapper
