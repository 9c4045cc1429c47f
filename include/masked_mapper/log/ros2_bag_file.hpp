// SPDX-License-Identifier: BSD-3-Clause
// The messages of one file of a ROS 2 bag that is stored in SQLite (.db3), in the order of
// recording; each may be packed with zstd on its own (rosbag2's `--compression-mode message`).
//
// A file from elsewhere is opened read-only, its tables must be plain ones, a value has a greatest
// size, and a step a greatest length, so that no schema can keep the reader busy.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "masked_mapper/log/ros_bag.hpp"

namespace masked_mapper {

class Ros2BagFile final : public RosBag {
 public:
  /// Throws InputError, with `shown_name` for the file: no bag, cannot be opened.
  Ros2BagFile(const std::string& path, const std::string& shown_name);
  ~Ros2BagFile() override;

  std::optional<BagMessage> Next() override;
  void Rewind() override;
  const std::map<std::uint32_t, BagConnection>& Connections() const override;
  bool IsIndexed() const override { return true; }
  std::optional<double> EndTime() const override;
  bool Truncated() const override;
  std::uint64_t Damaged() const override;
  double Progress() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
