// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are the same on every platform: integer arithmetic only, since the standard
// library's distributions (std::normal_distribution ...) differ between implementations.
// The generator is SplitMix64 (Steele, Lea, Flood 2014).
#pragma once

#include <cstdint>
#include <string_view>

namespace masked_mapper {

class RandomGenerator {
 public:
  explicit RandomGenerator(std::uint64_t seed) : state_(seed) {}
  /// A stream of its own for every purpose, so that switching one noise off changes no other.
  RandomGenerator(std::uint64_t seed, std::string_view purpose);

  std::uint64_t Next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  /// In [0, 1), a multiple of 2^-53.
  double Uniform() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// In [0, count); count > 0. The bias of the plain remainder is below 2^-40 for counts below
  /// 2^24.
  std::uint64_t Below(std::uint64_t count) { return Next() % count; }
  bool Chance(double probability) { return Uniform() < probability; }

  /// Mean 0, deviation 1: the sum of twelve 16-bit uniform numbers (Irwin-Hall), exact in integers;
  /// nothing lies beyond 6. Three draws per number.
  double Normal();

 private:
  std::uint64_t state_;
};

}  // namespace masked_mapper
