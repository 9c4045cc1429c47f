// SPDX-License-Identifier: BSD-3-Clause
// The messages of one MCAP file in the order of their time of logging, whatever the order of its
// chunks. Chunks that overlap in time are read side by side as far as memory allows.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "masked_mapper/log/ros_bag.hpp"

namespace masked_mapper {

class McapFile final : public RosBag {
 public:
  /// Throws InputError, with `shown_name` for the file: cannot be opened, no MCAP of version 0.
  McapFile(const std::string& path, const std::string& shown_name);
  ~McapFile() override;

  std::optional<BagMessage> Next() override;
  void Rewind() override;
  const std::map<std::uint32_t, BagConnection>& Connections() const override;
  bool IsIndexed() const override { return true; }
  bool Truncated() const override;
  std::uint64_t Damaged() const override;
  std::string FirstDamage() const override;
  double Progress() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
