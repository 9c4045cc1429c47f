// SPDX-License-Identifier: BSD-3-Clause
#include "random_generator.hpp"

namespace masked_mapper {

RandomGenerator::RandomGenerator(std::uint64_t seed, std::string_view purpose) : state_(seed) {
  // FNV-1a of the purpose, mixed with a first output so that near seeds give far streams.
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : purpose) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  state_ = Next() ^ hash;
}

double RandomGenerator::Normal() {
  std::uint64_t sum = 0;
  for (int draw = 0; draw < 3; ++draw) {
    const std::uint64_t bits = Next();
    sum += (bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48);
  }
  // Each part has mean 65535 / 2 and deviation 65536 / sqrt(12).
  return (static_cast<double>(sum) - 6.0 * 65535.0) / 65536.0;
}

}  // namespace masked_mapper
