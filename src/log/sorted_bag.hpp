// SPDX-License-Identifier: BSD-3-Clause
// A bag whose messages do not stand in the order of their recording (whole topics one after the
// other), read in that order. What is read of it is sorted in runs that fit in memory, kept in a
// temporary file, and merged: memory does not grow with the bag.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bag_around_bag.hpp"

namespace masked_mapper {

class SortedBag final : public BagAroundBag {
 public:
  /// `is_wanted`: whether the messages of a connection are to be kept; of the others only that they
  /// were there. Reads the bag to its end. Throws InputError: no room for the temporary file.
  SortedBag(std::unique_ptr<RosBag> bag, const std::function<bool(std::uint32_t)>& is_wanted,
            std::size_t run_bytes = std::size_t{32} << 20U);
  ~SortedBag() override;

  std::optional<BagMessage> Next() override;
  void Rewind() override;
  bool IsIndexed() const override { return true; }
  double Progress() const override;

 private:
  class File;
  class Run;

  std::unique_ptr<File> file_;
  std::vector<std::unique_ptr<Run>> runs_;
  std::vector<std::size_t> open_runs_;  ///< that have a message left, in their order
  std::uint64_t messages_ = 0;
  std::uint64_t given_ = 0;
};

}  // namespace masked_mapper
