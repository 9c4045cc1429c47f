// SPDX-License-Identifier: BSD-3-Clause
#include "localization/evidence.hpp"

#include <gtest/gtest.h>

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

TEST(Evidence, NothingSeenTellsNothing) {
  const EvidenceOptions options;
  EXPECT_DOUBLE_EQ(LeadOf({}, {}, options), 0.0);
  EXPECT_DOUBLE_EQ(LeadOf(Fits(0, 0), Fits(5, 5), options), 0.0);
  EXPECT_DOUBLE_EQ(NatsOf({}, options.agrees_anywhere, options), 0.0);
}

}  // namespace
}  // namespace masked_mapper
