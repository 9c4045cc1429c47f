// SPDX-License-Identifier: BSD-3-Clause
// What the records of a ROS 1 bag are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace masked_mapper {

std::uint64_t LittleEndian(const unsigned char* bytes, std::size_t count);

/// The header of a record: fields `name=value`, each with its length before it. The bytes must
/// outlive it.
class RecordHeader {
 public:
  /// False when the lengths do not add up.
  bool Parse(const unsigned char* data, std::size_t size);

  /// The value of a field; empty when there is none.
  std::string_view Find(std::string_view name) const;

  /// A number of exactly `size` bytes.
  std::optional<std::uint64_t> Number(std::string_view name, std::size_t size) const;

  int op() const { return static_cast<int>(Number("op", 1).value_or(0)); }

 private:
  const unsigned char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace masked_mapper
