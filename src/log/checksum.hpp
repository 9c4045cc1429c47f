// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>

namespace masked_mapper {

/// CRC-32 of bytes that follow others; of the first, `before` is 0.
inline std::uint32_t Crc32After(std::uint32_t before, const void* data, std::size_t size) {
  return static_cast<std::uint32_t>(crc32_z(before, static_cast<const unsigned char*>(data), size));
}

}  // namespace masked_mapper
