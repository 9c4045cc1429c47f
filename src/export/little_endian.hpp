// SPDX-License-Identifier: BSD-3-Clause
// Numbers as the binary files of points hold them: PCD, PLY and LAS.
#pragma once

#include <cstring>
#include <string>

namespace masked_mapper {

// The formats are little-endian here, and so is every machine that this is built for.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

template <typename T>
void Append(const T& value, std::string* bytes) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes->append(raw, sizeof(T));
}

}  // namespace masked_mapper
