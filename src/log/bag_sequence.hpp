// SPDX-License-Identifier: BSD-3-Clause
// Several bags of one recording, one after the other in the order given, as one bag.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/log/ros_bag.hpp"

namespace masked_mapper {

class BagSequence final : public RosBag {
 public:
  /// Throws InputError: a file that cannot be read as a bag.
  explicit BagSequence(const std::vector<std::string>& paths);

  std::optional<BagMessage> Next() override;
  void Rewind() override;
  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override;
  bool Truncated() const override;
  std::uint64_t Damaged() const override;
  double Progress() const override;

 private:
  struct Part {
    std::unique_ptr<RosBag> bag;
    std::map<std::uint32_t, std::uint32_t> numbers;  ///< its connections among those of all
  };
  std::uint32_t NumberOf(Part* part, std::uint32_t connection);

  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<Part> parts_;
  std::size_t part_ = 0;
};

}  // namespace masked_mapper
