// SPDX-License-Identifier: BSD-3-Clause
#include "row_values.hpp"

#include <cmath>
#include <limits>

#include "map_rows.hpp"
#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "packed_bytes.hpp"

namespace masked_mapper {
namespace {

/// Packed bytes may grow so much; real ones stay below a tenth of it.
constexpr std::uint64_t kLargestGrowth = 256;

}  // namespace

void Malformed(const std::string& table, const std::string& what) {
  throw DatabaseError("table " + table + ": " + what);
}

void TakeId(Statement& row, std::size_t expected, const std::string& table) {
  if (row.Integer() != static_cast<std::int64_t>(expected)) Malformed(table, "a row is missing");
}

double TakeFinite(Statement& row, const std::string& table) {
  const double value = row.Real();
  if (!std::isfinite(value)) Malformed(table, "a number is not finite");
  return value;
}

Pose2 TakePose(Statement& row, const std::string& table) {
  Pose2 pose;
  pose.x = TakeFinite(row, table);
  pose.y = TakeFinite(row, table);
  pose.theta = TakeFinite(row, table);
  return pose;
}

Eigen::Matrix3d TakeCovariance(Statement& row, const std::string& table) {
  std::string_view bytes = row.Blob();
  if (bytes.size() != kCovarianceBytes) Malformed(table, "a covariance of the wrong size");
  Eigen::Matrix3d covariance;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) covariance(i, j) = TakeNumber<double>(bytes);
  }
  if (!IsCovariance(covariance)) Malformed(table, "a covariance that is none");
  return covariance;
}

std::int64_t TakeBelow(Statement& row, std::size_t limit, const std::string& table,
                       const std::string& what) {
  const std::int64_t value = row.Integer();
  if (value < 0 || static_cast<std::uint64_t>(value) >= limit) {
    Malformed(table, what + " " + std::to_string(value) + " does not exist");
  }
  return value;
}

std::int32_t TakeIdOrNone(Statement& row, const std::string& table, const std::string& what) {
  if (row.NextType() == ValueType::kNull) {
    row.Skip();
    return -1;
  }
  return static_cast<std::int32_t>(
      TakeBelow(row, std::numeric_limits<std::int32_t>::max(), table, what));
}

bool TakeFlag(Statement& row, const std::string& table) {
  return TakeBelow(row, 2, table, "the flag") == 1;
}

PackedColumns::PackedColumns(std::uint64_t file_size)
    : bytes_left_(file_size * kLargestGrowth + (1U << 20U)) {}

std::string PackedColumns::Take(Statement& row, std::int64_t count, std::size_t width,
                                const std::string& table) {
  const std::string_view packed = row.Blob();
  if (row.Integer() != std::int64_t{Checksum(packed)}) {
    Malformed(table, "bytes that do not fit their checksum");
  }
  if (count < 0 || static_cast<std::uint64_t>(count) > bytes_left_ / width) {
    Malformed(table, "more is promised than the file can hold");
  }
  const std::size_t size = static_cast<std::size_t>(count) * width;
  bytes_left_ -= size;
  return Unpack(packed, width, size);
}

}  // namespace masked_mapper
