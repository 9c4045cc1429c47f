// SPDX-License-Identifier: BSD-3-Clause
// What a program that packs would have written. (Gzipped() stands in temporary_file.hpp.)
#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <string>

namespace masked_mapper {

inline std::string ZstdPacked(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

inline std::string Lz4Packed(const std::string& bytes) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

inline std::string Bzip2Packed(const std::string& bytes) {
  std::string input = bytes;
  std::string packed(bytes.size() + bytes.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, input.data(),
                                     static_cast<unsigned>(input.size()), 9, 0, 0),
            BZ_OK);
  packed.resize(size);
  return packed;
}

}  // namespace masked_mapper
