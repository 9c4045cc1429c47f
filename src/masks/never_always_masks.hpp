// SPDX-License-Identifier: BSD-3-Clause
// The two masks without a condition (Section III-D, 1 and 2).
#pragma once

#include "masked_mapper/masks/mask_registry.hpp"

namespace masked_mapper {

/// Dead reckoning: no scan is worth a node.
class NeverMask : public Mask {
 public:
  void Observe(const MaskObservation& /*observation*/) override {}
  bool Fires() const override { return false; }
  void Restart() override {}
};

/// The costly baseline: scan nodes at the highest density that the minimum edge length allows.
class AlwaysMask : public Mask {
 public:
  void Observe(const MaskObservation& /*observation*/) override {}
  bool Fires() const override { return true; }
  void Restart() override {}
};

}  // namespace masked_mapper
