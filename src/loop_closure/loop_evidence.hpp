// SPDX-License-Identifier: BSD-3-Clause
// What a loop that nearly closes is worth as evidence, in nats: the logarithm of how much likelier
// it is that its match is right than that the match is wrong and landed there by chance. Ours,
// instead of the paper's votes, which count a loop that anything would close as much as one that
// hardly anything would.
#pragma once

#include "masked_mapper/geometry/uncertain_pose2.hpp"

namespace masked_mapper {

/// Odds of 16 to 1: evidence from which a match is believed.
constexpr double kEnoughNats = 2.772588722239781;

/// A right match leaves the loop its own error: normal, with a sigma that is itself known only
/// about so well. Wrong ones are spread evenly over where was searched, one in 250 m^2, nearly all
/// turned as the right one would be, and lie more than 0.5 m or 5 degrees off; nearer, they would
/// be right. Beside the right place lie those that slipped, one in 50. `loop`: round from one end
/// of the match to the same end. Unlimited against; a loop that nearly anything would close is
/// evidence of next to nothing.
double LoopEvidence(const UncertainPose2& loop);

/// How probable it is that what is known as well as `known` is more than 0.5 m or 5 degrees off the
/// identity; a bound from above, 0-1.
double ChanceToBeWrong(const UncertainPose2& known);

/// What a match that agrees is worth at most: wrong ones agree where a building repeats itself,
/// which it does over 8 m more with odds of 1 to 4. `apart_m`: between the places of the two.
double MostEvidenceOfWitness(double apart_m);

}  // namespace masked_mapper
