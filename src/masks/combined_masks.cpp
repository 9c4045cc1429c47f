// SPDX-License-Identifier: BSD-3-Clause
#include "combined_masks.hpp"

#include <algorithm>

namespace masked_mapper {
namespace {

bool PartFires(const std::unique_ptr<Mask>& part) { return part->Fires(); }

}  // namespace

void CombinedMask::Observe(const MaskObservation& observation) {
  for (const auto& part : parts_) part->Observe(observation);
}

void CombinedMask::OnNode() {
  for (const auto& part : parts_) part->OnNode();
}

void CombinedMask::Restart() {
  for (const auto& part : parts_) part->Restart();
}

bool AnyMask::Fires() const { return std::any_of(parts().begin(), parts().end(), PartFires); }

bool AllMask::Fires() const { return std::all_of(parts().begin(), parts().end(), PartFires); }

bool NotMask::Fires() const { return std::none_of(parts().begin(), parts().end(), PartFires); }

}  // namespace masked_mapper
