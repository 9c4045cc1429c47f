// SPDX-License-Identifier: BSD-3-Clause
// `sparse(part)`: another mask, less often on new ground (ours). Node after node along one pass is
// offered to its own predecessors (Section III-B), which tells nothing that odometry does not know:
// on logs of several buildings half of all attempts. So scan nodes stand apart where the robot has
// not been, and as its part says where it has: there they close loops, and every one of them helps.
#pragma once

#include <memory>
#include <vector>

#include "combined_masks.hpp"
#include "masked_mapper/masks/mask_options.hpp"

namespace masked_mapper {

/// Fires when its one part does and the scan is either apart from the scan nodes of this pass that
/// saw the same, or sees what was seen in an earlier pass. A corridor driven back is new ground to
/// a scanner that does not see behind.
class SparseMask : public CombinedMask {
 public:
  SparseMask(std::vector<std::unique_ptr<Mask>> part, const SparseMaskOptions& options)
      : CombinedMask(std::move(part)), options_(options) {}

  void Observe(const MaskObservation& observation) override;
  bool Fires() const override { return fires_; }
  void OnNode() override;
  void Restart() override;

 private:
  struct View {
    double path_length = 0.0;  ///< m, up to here
    Pose2 T_odom_robot;
  };

  bool SeesTheSame(const View& earlier) const;
  bool IsApart() const;
  bool IsRevisit() const;

  SparseMaskOptions options_;
  View now_;
  bool sees_all_around_ = false;  ///< the scan observed last
  std::vector<View> nodes_;       ///< of this pass, oldest first
  std::vector<View> path_;        ///< thinned, oldest first; empty before the first scan
  bool fires_ = false;
};

}  // namespace masked_mapper
