// SPDX-License-Identifier: BSD-3-Clause
// A bag that is another bag but for what is overridden.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ros_bag.hpp"

namespace masked_mapper {

class BagAroundBag : public RosBag {
 public:
  std::optional<BagMessage> Next() override { return bag_->Next(); }
  void Rewind() override { bag_->Rewind(); }
  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return bag_->Connections();
  }
  bool IsIndexed() const override { return bag_->IsIndexed(); }
  std::optional<double> EndTime() const override { return bag_->EndTime(); }
  bool Truncated() const override { return bag_->Truncated(); }
  std::uint64_t Damaged() const override { return bag_->Damaged(); }
  std::string FirstDamage() const override { return bag_->FirstDamage(); }
  double Progress() const override { return bag_->Progress(); }

 protected:
  explicit BagAroundBag(std::unique_ptr<RosBag> bag) : bag_(std::move(bag)) {}
  RosBag& bag() { return *bag_; }

 private:
  std::unique_ptr<RosBag> bag_;
};

}  // namespace masked_mapper
