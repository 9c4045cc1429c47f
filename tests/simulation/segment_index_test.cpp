// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/segment_index.hpp"

#include <gtest/gtest.h>

#include "simulation/random_generator.hpp"

namespace masked_mapper {
namespace {

std::vector<Segment> RandomSegments(RandomGenerator& random, int count, double size,
                                    double length) {
  std::vector<Segment> segments;
  for (int i = 0; i < count; ++i) {
    Segment segment;
    segment.a.x() = random.Uniform(-size, size);
    segment.a.y() = random.Uniform(-size, size);
    segment.b.x() = segment.a.x() + random.Uniform(-length, length);
    // Every third along an axis, as walls are.
    segment.b.y() = segment.a.y() + (i % 3 == 0 ? 0.0 : random.Uniform(-length, length));
    segments.push_back(segment);
  }
  return segments;
}

TEST(SegmentIndex, CastEqualsTryingEverySegment) {
  RandomGenerator random(5);
  for (int scene = 0; scene < 30; ++scene) {
    const SegmentIndex index(RandomSegments(random, 1 + 20 * scene, 20.0, 6.0));
    for (int ray = 0; ray < 300; ++ray) {
      const double x = random.Uniform(-30.0, 30.0);
      const double y = random.Uniform(-30.0, 30.0);
      const double angle = ray % 10 == 0 ? 0.5 * kPi * (ray % 4) : random.Uniform(-kPi, kPi);
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const double min_range = random.Uniform(0.0, 3.0);
      const double max_range = random.Uniform(5.0, 60.0);
      std::optional<SegmentIndex::Hit> expected;
      for (std::uint32_t i = 0; i < index.segments().size(); ++i) {
        const auto range = RayRange({x, y}, direction, index.segments()[i], min_range);
        if (range && *range < (expected ? expected->range : max_range)) expected = {*range, i};
      }
      const auto found = index.Cast({x, y}, direction, min_range, max_range);
      ASSERT_EQ(found.has_value(), expected.has_value()) << "scene " << scene << " ray " << ray;
      if (!found) continue;
      EXPECT_EQ(found->range, expected->range);
      EXPECT_EQ(found->segment, expected->segment);
    }
  }
}

TEST(SegmentIndex, ClearanceEqualsSampling) {
  RandomGenerator random(6);
  const SegmentIndex index(RandomSegments(random, 60, 15.0, 5.0));
  for (int way = 0; way < 200; ++way) {
    const double ax = random.Uniform(-18.0, 18.0);
    const double ay = random.Uniform(-18.0, 18.0);
    const Eigen::Vector2d a(ax, ay);
    const double bx = ax + random.Uniform(-4.0, 4.0);
    const double by = ay + random.Uniform(-4.0, 4.0);
    const Eigen::Vector2d b(bx, by);
    constexpr double kLimit = 2.0;
    double sampled = kLimit;
    constexpr int kSteps = 2000;
    for (int step = 0; step <= kSteps; ++step) {
      const Eigen::Vector2d at = a + (b - a) * step / kSteps;
      for (const Segment& segment : index.segments()) {
        sampled = std::min(sampled, DistanceToSegment(at, segment.a, segment.b));
      }
    }
    EXPECT_NEAR(index.Clearance(a, b, kLimit), sampled, 2e-3) << "m";
  }
}

TEST(SegmentIndex, NothingStandsInAnEmptyScene) {
  const SegmentIndex index({});
  EXPECT_FALSE(index.Cast({0.0, 0.0}, {1.0, 0.0}, 0.0, 30.0));
  EXPECT_EQ(index.Clearance({1.0, 2.0}, 0.7), 0.7);
}

TEST(SegmentIndex, OnePointIsNoObstacleToCrash) {
  const SegmentIndex index({{{1.0, 1.0}, {1.0, 1.0}, Surface::kWall}});
  EXPECT_FALSE(index.Cast({0.0, 0.0}, {1.0, 0.0}, 0.0, 30.0));
  EXPECT_NEAR(index.Clearance({1.0, 0.5}, 2.0), 0.5, 1e-12);
}

}  // namespace
}  // namespace masked_mapper
