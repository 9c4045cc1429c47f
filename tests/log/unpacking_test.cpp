// SPDX-License-Identifier: BSD-3-Clause
#include "log/unpacking.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "log/packed_bytes.hpp"
#include "log/temporary_file.hpp"

namespace masked_mapper {
namespace {

const unsigned char* Data(const std::string& bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

std::string SomeText(std::size_t size) {
  std::mt19937 random(7);
  std::string text(size, 'x');
  for (char& c : text) c = static_cast<char>('a' + random() % 7);
  return text;
}

struct PackingCase {
  Packing packing;
  std::string (*pack)(const std::string&);
};

class UnpackingTest : public ::testing::TestWithParam<PackingCase> {};

TEST_P(UnpackingTest, GivesBackWhatWasPacked) {
  const std::unique_ptr<Unpacker> unpacker = MakeUnpacker(GetParam().packing);
  Bytes out;
  for (const std::size_t size : {0U, 1U, 70000U, 500000U, 10U}) {
    const std::string text = SomeText(size);
    const std::string packed = GetParam().pack(text);
    EXPECT_EQ(PackingOf(Data(packed), packed.size()), GetParam().packing);
    EXPECT_TRUE(UnpackAll(unpacker.get(), Data(packed), packed.size(), 1U << 20U, &out));
    EXPECT_EQ(std::string(out.begin(), out.end()), text);
    EXPECT_LE(static_cast<double>(size),
              GreatestRatio(GetParam().packing) * static_cast<double>(packed.size()));
  }
}

TEST_P(UnpackingTest, NeverMoreThanTheLimit) {
  const std::unique_ptr<Unpacker> unpacker = MakeUnpacker(GetParam().packing);
  const std::string packed = GetParam().pack(std::string(std::size_t{64} << 20U, '\0'));
  Bytes out;
  UnpackAll(unpacker.get(), Data(packed), packed.size(), 1000, &out);
  EXPECT_EQ(out.size(), 1000U);
  EXPECT_LT(out.capacity(), std::size_t{1} << 17U);
  EXPECT_LT(double(std::size_t{64} << 20U),
            GreatestRatio(GetParam().packing) * static_cast<double>(packed.size()));
}

TEST_P(UnpackingTest, OfACutOrSpoiltStreamTheGoodPart) {
  const std::unique_ptr<Unpacker> unpacker = MakeUnpacker(GetParam().packing);
  const std::string text = SomeText(300000);
  std::string packed = GetParam().pack(text);
  Bytes out;
  EXPECT_FALSE(UnpackAll(unpacker.get(), Data(packed), packed.size() / 2, 1U << 20U, &out));
  EXPECT_LT(out.size(), text.size());
  EXPECT_EQ(std::string(out.begin(), out.end()), text.substr(0, out.size()));
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    std::string spoilt = packed;
    spoilt[random() % spoilt.size()] = static_cast<char>(random());
    UnpackAll(unpacker.get(), Data(spoilt), spoilt.size(), 1U << 20U, &out);
  }
}

INSTANTIATE_TEST_SUITE_P(All, UnpackingTest,
                         ::testing::Values(PackingCase{Packing::kGzip, &Gzipped},
                                           PackingCase{Packing::kBzip2, &Bzip2Packed},
                                           PackingCase{Packing::kZstd, &ZstdPacked},
                                           PackingCase{Packing::kLz4, &Lz4Packed}));

}  // namespace
}  // namespace masked_mapper
