// SPDX-License-Identifier: BSD-3-Clause
// The messages of a ROS 2 bag that is stored in SQLite: one .db3 file, or the folder that holds one
// or several beside its metadata.yaml. Files follow each other by their first message; within a
// file the order is that of recording. The metadata tells nothing that the files do not, and is not
// read.
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
  /// Whether a path is an SQLite file, or a folder with a metadata.yaml or a .db3 in it.
  static bool IsBag(const std::string& path);

  /// Throws InputError: no bag, compressed, MCAP, cannot be opened.
  explicit Ros2BagFile(const std::string& path);
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
