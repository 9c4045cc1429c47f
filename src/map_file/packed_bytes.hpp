// SPDX-License-Identifier: BSD-3-Clause
// Numbers as bytes, little end first; bytes packed with zlib.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace masked_mapper {

/// What a checksum over all of it gives (CRC-32 as in gzip).
std::uint32_t Checksum(std::string_view bytes, std::uint32_t before = 0);

/// The bytes of the n-th of every `width` bytes after those of the (n-1)-th, then packed: numbers
/// of one kind differ less in their high bytes than in their low ones.
std::string Pack(std::string_view bytes, std::size_t width);

/// The reverse, of exactly `size` bytes. Throws DatabaseError when there are more or fewer.
std::string Unpack(std::string_view packed, std::size_t width, std::size_t size);

template <typename Number>
void AppendBytes(Number number, std::string& bytes) {
  static_assert(std::is_arithmetic_v<Number> && sizeof(Number) <= 8);
  std::uint64_t bits = 0;
  if constexpr (std::is_same_v<Number, float>) {
    std::uint32_t narrow = 0;
    std::memcpy(&narrow, &number, sizeof narrow);
    bits = narrow;
  } else if constexpr (std::is_same_v<Number, double>) {
    std::memcpy(&bits, &number, sizeof bits);
  } else {
    bits = static_cast<std::uint64_t>(number);
  }
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes += static_cast<char>((bits >> (8U * i)) & 0xffU);
  }
}

/// Takes a number from the front of `bytes`, which has as many.
template <typename Number>
Number TakeNumber(std::string_view& bytes) {
  static_assert(std::is_arithmetic_v<Number> && sizeof(Number) <= 8);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bits |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8U * i);
  }
  bytes.remove_prefix(sizeof(Number));
  Number number{};
  if constexpr (std::is_same_v<Number, float>) {
    const auto narrow = static_cast<std::uint32_t>(bits);
    std::memcpy(&number, &narrow, sizeof number);
  } else if constexpr (std::is_same_v<Number, double>) {
    std::memcpy(&number, &bits, sizeof number);
  } else {
    number = static_cast<Number>(bits);
  }
  return number;
}

}  // namespace masked_mapper
