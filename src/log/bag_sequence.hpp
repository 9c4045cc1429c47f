// SPDX-License-Identifier: BSD-3-Clause
// Several bags of one recording, one after the other, as one bag.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros_bag.hpp"

namespace masked_mapper {

class BagSequence final : public RosBag {
 public:
  enum class Order { kAsGiven, kByTime };  ///< of the files; by time: of their first messages

  /// Throws InputError: a file that cannot be read as a bag.
  BagSequence(const std::vector<std::string>& paths, Order order);

  std::optional<BagMessage> Next() override;
  void Rewind() override;
  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override { return true; }
  std::optional<double> EndTime() const override { return end_time_; }
  bool Truncated() const override { return truncated_ || (open_ && open_->Truncated()); }
  std::uint64_t Damaged() const override { return damaged_ + (open_ ? open_->Damaged() : 0); }
  std::string FirstDamage() const override;
  double Progress() const override;

 private:
  struct Part {
    std::string path;
    double first_time = 0.0;                         ///< s
    std::map<std::uint32_t, std::uint32_t> numbers;  ///< its connections among those of all
  };

  Part Survey(const std::string& path);
  std::uint32_t NumberOf(const BagConnection& connection);
  void ClosePart();

  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<Part> parts_;
  std::size_t part_ = 0;
  std::unique_ptr<RosBag> open_;    ///< one at a time: there may be more than a process may open
  std::optional<double> end_time_;  ///< s, of the latest; empty: some part does not tell
  bool truncated_ = false;
  std::uint64_t damaged_ = 0;
  std::string first_damage_;
};

}  // namespace masked_mapper
