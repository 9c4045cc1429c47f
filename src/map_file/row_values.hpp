// SPDX-License-Identifier: BSD-3-Clause
// Values of a row, believed only when they can be. Written as if the file came from an enemy:
// whatever cannot be is a DatabaseError that names the table.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "database.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/text/enum_names.hpp"

namespace masked_mapper {

[[noreturn]] void Malformed(const std::string& table, const std::string& what);

/// Ids count from 0 without a gap, since rows refer to each other by place.
void TakeId(Statement& row, std::size_t expected, const std::string& table);
double TakeFinite(Statement& row, const std::string& table);
Pose2 TakePose(Statement& row, const std::string& table);
Eigen::Matrix3d TakeCovariance(Statement& row, const std::string& table);
/// 0 to `limit` - 1; `what` is what such a number counts.
std::int64_t TakeBelow(Statement& row, std::size_t limit, const std::string& table,
                       const std::string& what);
/// -1 where there is none; that it exists is for later.
std::int32_t TakeIdOrNone(Statement& row, const std::string& table, const std::string& what);
bool TakeFlag(Statement& row, const std::string& table);

template <typename Enum>
Enum ValueNamed(std::string_view name, const std::string& table) {
  const std::optional<Enum> value = FromName<Enum>(name);
  if (!value) Malformed(table, "an unknown name");
  return *value;
}

/// Packed columns of one file, which may unpack to so much in all as the file pays for in bytes.
class PackedColumns {
 public:
  explicit PackedColumns(std::uint64_t file_size);

  /// The bytes of `count` records of `width` bytes, of the columns bytes and checksum.
  std::string Take(Statement& row, std::int64_t count, std::size_t width, const std::string& table);

 private:
  std::uint64_t bytes_left_;
};

}  // namespace masked_mapper
