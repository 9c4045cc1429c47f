// SPDX-License-Identifier: BSD-3-Clause
#include "open_bag.hpp"

#include "masked_mapper/log/bag_file.hpp"
#include "masked_mapper/log/ros2_bag_file.hpp"

namespace masked_mapper {

bool IsBag(const std::string& path) { return BagFile::IsBag(path) || Ros2BagFile::IsBag(path); }

std::unique_ptr<RosBag> OpenBag(const std::string& path) {
  if (Ros2BagFile::IsBag(path)) return std::make_unique<Ros2BagFile>(path);
  return std::make_unique<BagFile>(path);
}

}  // namespace masked_mapper
