// SPDX-License-Identifier: BSD-3-Clause
// Combinations of masks. Every part sees every scan, every node and every restart, whether or not
// its answer is needed: a mask with a memory must not miss anything.
#pragma once

#include <memory>
#include <vector>

#include "masked_mapper/masks/mask_registry.hpp"

namespace masked_mapper {

/// What `any`, `all` and `not` share.
class CombinedMask : public Mask {
 public:
  explicit CombinedMask(std::vector<std::unique_ptr<Mask>> parts) : parts_(std::move(parts)) {}

  void Observe(const MaskObservation& observation) override;
  void OnNode() override;
  void Restart() override;

 protected:
  const std::vector<std::unique_ptr<Mask>>& parts() const { return parts_; }

 private:
  std::vector<std::unique_ptr<Mask>> parts_;
};

/// Fires when at least one part does.
class AnyMask : public CombinedMask {
 public:
  using CombinedMask::CombinedMask;
  bool Fires() const override;
};

/// Fires when every part does.
class AllMask : public CombinedMask {
 public:
  using CombinedMask::CombinedMask;
  bool Fires() const override;
};

/// Fires when its one part does not.
class NotMask : public CombinedMask {
 public:
  using CombinedMask::CombinedMask;
  bool Fires() const override;
};

}  // namespace masked_mapper
