// SPDX-License-Identifier: BSD-3-Clause
// The messages of a bag, read and unpacked in a thread of their own a little ahead of whoever takes
// them, and clouds parsed where they lie: that takes as long as to make something of them. What is
// handed out does not depend on the threads' timing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/log/run_ahead.hpp"
#include "ros_bag.hpp"

namespace masked_mapper {

class BagAhead final : public RosBag {
 public:
  using IsCloud = std::function<bool(std::uint32_t connection)>;

  /// `bag` knows its connections, and is this one's alone as long as this lives. `is_cloud`, which
  /// the thread asks: whether the messages of a connection are clouds that are read.
  explicit BagAhead(RosBag* bag, IsCloud is_cloud = {});

  /// Throws what the bag threw.
  std::optional<BagMessage> Next() override;
  void Rewind() override;

  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override { return true; }
  bool Truncated() const override { return batch_.truncated; }
  std::uint64_t Damaged() const override { return batch_.damaged; }
  std::string FirstDamage() const override { return batch_.first_damage; }
  double Progress() const override { return batch_.progress; }

 private:
  /// Messages, and the state of the bag as of behind them.
  struct Batch {
    std::vector<BagMessage> messages;  ///< without their data
    /// Where that begins in `bytes`, of messages whose cloud was not parsed.
    std::vector<std::size_t> begins;
    std::vector<unsigned char> bytes;
    bool truncated = false;
    std::uint64_t damaged = 0;
    std::string first_damage;
    double progress = 0.0;
  };

  void Start();
  /// False at the end of the bag.
  bool Fill(Batch* batch);

  RosBag& bag_;
  IsCloud is_cloud_;
  std::map<std::uint32_t, BagConnection> connections_;
  Batch batch_;
  std::size_t next_ = 0;
  std::optional<RunAhead<Batch>> batches_;
};

}  // namespace masked_mapper
