// SPDX-License-Identifier: BSD-3-Clause
#include "localization/evidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr PatchFit kGood = 90;
constexpr PatchFit kBad = 10;

std::vector<PatchFit> Fits(int good, int bad) {
  std::vector<PatchFit> fits(static_cast<std::size_t>(good), kGood);
  fits.insert(fits.end(), static_cast<std::size_t>(bad), kBad);
  return fits;
}

TEST(Evidence, OneOfTwoPlacesLeadsByWhatTheOtherDoesNotExplain) {
  const std::vector<PatchFit> right = Fits(40, 0);
  const std::vector<PatchFit> wrong = Fits(20, 20);
  const EvidenceOptions options;
  EXPECT_GT(LeadOf(right, wrong, options), options.told_apart_nats);
  EXPECT_DOUBLE_EQ(LeadOf(right, wrong, options), -LeadOf(wrong, right, options));
}

TEST(Evidence, CopiesAreNotToldApartByNoise) {
  std::vector<PatchFit> one = Fits(300, 0);
  std::vector<PatchFit> other = one;
  for (std::size_t i = 0; i < 12; ++i) one[i] = kBad;
  for (std::size_t i = 100; i < 118; ++i) other[i] = kBad;
  const EvidenceOptions options;
  EXPECT_LT(std::abs(LeadOf(one, other, options)), options.told_apart_nats);
}

// The map knows more of one copy: that is no evidence that the robot is there.
TEST(Evidence, ACopyOfWhichTheMapKnowsMoreDoesNotLead) {
  const std::vector<PatchFit> well_known = Fits(200, 0);
  std::vector<PatchFit> half_known = well_known;
  for (std::size_t i = 100; i < 200; ++i) half_known[i] = kMapSaysNothing;
  const EvidenceOptions options;
  EXPECT_LT(std::abs(LeadOf(well_known, half_known, options)), options.told_apart_nats);
}

TEST(Evidence, WhatDiffersTellsCopiesApart) {
  const std::vector<PatchFit> right = Fits(200, 0);
  const std::vector<PatchFit> copy = Fits(188, 12);
  const EvidenceOptions options;
  EXPECT_GT(LeadOf(right, copy, options), options.told_apart_nats);
}

// Where the map shows little of a place, that it is a copy of another for ever on is not for free;
// the less so the more they differ where it shows both.
TEST(Evidence, APlaceThatIsACopyOnlyWhereTheMapHasNothingFallsBehind) {
  const EvidenceOptions options;
  const auto lead = [&](std::size_t differing, std::size_t beyond) {
    std::vector<PatchFit> right = Fits(36, 0);
    std::vector<PatchFit> rival = right;
    std::fill_n(rival.begin(), differing, kBad);
    right.resize(36 + beyond, kGood);
    rival.resize(36 + beyond, kMapSaysNothing);
    return LeadOf(right, rival, options);
  };
  EXPECT_LT(lead(0, 10), lead(0, 60));
  EXPECT_LT(lead(0, 60), lead(0, 300));
  EXPECT_LT(lead(0, 300), options.told_apart_nats);
  EXPECT_GT(lead(4, 60) - lead(4, 0), lead(0, 60) - lead(0, 0) + 1.0);
}

// What is noise speaks for either; but noise is rare, as what both places show tells.
TEST(Evidence, WhatDiffersMoreOftenThanNoiseTellsPlacesApart) {
  const EvidenceOptions options;
  std::vector<PatchFit> right = Fits(45, 0);
  std::vector<PatchFit> rival = right;
  std::fill_n(rival.begin(), 10, kBad);
  right[20] = kBad;
  EXPECT_GT(LeadOf(right, rival, options), options.told_apart_nats);
  // As many of ten times as much may well be noise.
  right.resize(450, kGood);
  rival.resize(450, kGood);
  EXPECT_LT(LeadOf(right, rival, options), options.told_apart_nats);
}

TEST(Evidence, HowMuchAgreesInTheRightPlaceIsLearntAlong) {
  const EvidenceOptions options;
  const auto nats_of = [&](int agreeing, int contradicting) {
    return NatsOfWay({agreeing, contradicting}, options);
  };
  EXPECT_DOUBLE_EQ(nats_of(0, 0), 0.0);
  EXPECT_NEAR(nats_of(1, 0), std::log(0.8 / 0.5), 1e-9);  // as expected beforehand
  // The next is the likelier to agree, the more did.
  EXPECT_GT(nats_of(41, 0) - nats_of(40, 0), nats_of(1, 0));
  EXPECT_LT(nats_of(31, 10) - nats_of(30, 10), nats_of(1, 0));
  EXPECT_LT(nats_of(20, 20), 0.0);
}

TEST(Evidence, ARobotIsSeldomOffTheMapAndThenForAWhile) {
  const EvidenceOptions options;
  // Ten patches every three metres, of which so many are unknown.
  const auto nats_of = [&](const std::vector<int>& unknown) {
    WayOffTheMap way;
    for (std::size_t look = 0; look <= unknown.size(); ++look) {
      for (int i = 0; i < 10; ++i) {
        const bool is_off = look < unknown.size() && i < unknown[look];
        way.Add(is_off ? kMapSaysNothing : kGood, 3.0 * static_cast<double>(look), options);
      }
    }
    return way.nats();
  };
  EXPECT_DOUBLE_EQ(nats_of({0, 0, 0}), 0.0);
  EXPECT_DOUBLE_EQ(nats_of({3, 4, 5, 2}), 0.0);  // rooms seen through doors
  const double once = std::log(3.0 * options.leaves_map_per_m);
  const double on = 3.0 * std::log(1.0 - options.comes_back_per_m);
  EXPECT_NEAR(nats_of({0, 10, 10, 10, 0}), once + 2.0 * on, 1e-9);
  EXPECT_NEAR(nats_of({10, 0, 10, 0, 10}), 3.0 * once, 1e-9);
}

TEST(Evidence, APlaceThatMovesAlongIsNotTheRightOne) {
  const EvidenceOptions options;
  EXPECT_DOUBLE_EQ(SlipNats(0.0, 0.0), 0.0);
  EXPECT_NEAR(SlipNats(0.1, 0.0), -0.5, 1e-9);
  EXPECT_GT(SlipNats(0.3, 60.0), -1.0);                      // half a percent is motion's own
  EXPECT_LT(SlipNats(1.0, 20.0), -options.told_apart_nats);  // five percent are not
  EXPECT_DOUBLE_EQ(SlipNats(50.0, 20.0), SlipNats(5.0, 20.0));
}

TEST(Evidence, NothingSeenTellsNothing) {
  const EvidenceOptions options;
  EXPECT_DOUBLE_EQ(LeadOf({}, {}, options), 0.0);
  EXPECT_DOUBLE_EQ(LeadOf(Fits(0, 0), Fits(5, 5), options), 0.0);
  EXPECT_DOUBLE_EQ(NatsOf({}, options.agrees_anywhere, options), 0.0);
}

}  // namespace
}  // namespace masked_mapper
