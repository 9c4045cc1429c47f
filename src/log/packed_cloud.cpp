// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/packed_cloud.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <vector>

namespace masked_mapper {
namespace {

// A voxel's key has its three indices, z in the highest bits, each counted from the lowest.
constexpr unsigned kAxisBits = 12;
constexpr unsigned kKeyBits = 3 * kAxisBits;
constexpr std::uint64_t kAxisMask = (1U << kAxisBits) - 1;
constexpr std::uint64_t kKeys = std::uint64_t{1} << kKeyBits;
// Below the key stands the place of the point in the cloud, where points are put in order.
constexpr unsigned kPlaceBits = 64 - kKeyBits;
constexpr std::uint64_t kPlaceMask = (std::uint64_t{1} << kPlaceBits) - 1;
constexpr std::int64_t kMiddle = 1U << (kAxisBits - 1);
constexpr auto kVoxelsPerMetre = static_cast<float>(1.0 / kPackedVoxel_m);
// Where in its voxel a point is, along each axis: finer than a scanner's noise.
constexpr unsigned kPartBits = 2;
constexpr float kParts = 1U << kPartBits;
constexpr std::uint32_t kPartMask = (1U << kPartBits) - 1;
constexpr float kFullIntensity = 255.0F;

constexpr std::size_t kMostVoxels = std::size_t{1} << 22U;
constexpr std::size_t kLongestStep = 6;  // bytes, of a key's bits by seven
constexpr unsigned kStepBits = 7;
constexpr std::size_t kBytesBesideStep = 2;  // part and intensity
constexpr int kZstdLevel = 1;                // clouds are packed while a log is read

/// What stands before the packed bytes.
struct Head {
  std::array<float, 3> lidar{};
  float ceiling = 0.0F;    ///< m; not a number: none is seen
  float intensity = 0.0F;  ///< the greatest
  std::uint32_t voxels = 0;
};
static_assert(sizeof(Head) == 24, "as it lies in memory it is written");

/// The index below a number, counted from the lowest; the library's own is a call.
std::int64_t IndexOf(float in_voxels) {
  const auto whole = static_cast<std::int64_t>(in_voxels);
  return whole - (static_cast<float>(whole) > in_voxels ? 1 : 0) + kMiddle;
}

/// Key and place in the cloud of every point, in order of both: by one axis after the other, each
/// time without changing the order of what is alike.
std::vector<std::uint64_t> SortedKeys(const CloudPoints& points) {
  std::array<std::vector<std::uint32_t>, 3> begins;  // by index along each axis
  for (std::vector<std::uint32_t>& axis : begins) axis.resize(kAxisMask + 2, 0);
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  const std::size_t most = std::min(points.size(), std::size_t{1} << kPlaceBits);
  for (std::size_t i = 0; i < most; ++i) {
    const Eigen::Vector3f in_voxels = points[i].position * kVoxelsPerMetre;
    if (!(in_voxels.cwiseAbs().maxCoeff() < static_cast<float>(kMiddle - 1))) continue;
    std::uint64_t key = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const auto index = static_cast<std::uint64_t>(IndexOf(in_voxels(axis)));
      ++begins[static_cast<std::size_t>(axis)][index + 1];
      key = key << kAxisBits | index;
    }
    keys.push_back(key << kPlaceBits | i);
  }
  std::vector<std::uint64_t> sorted(keys.size());
  unsigned shift = kPlaceBits;
  for (std::vector<std::uint32_t>& axis : begins) {
    for (std::size_t i = 1; i < axis.size(); ++i) axis[i] += axis[i - 1];
    for (const std::uint64_t key : keys) sorted[axis[key >> shift & kAxisMask]++] = key;
    keys.swap(sorted);
    shift += kAxisBits;
  }
  return keys;
}

/// In voxels, the corner that a key tells.
Eigen::Vector3f CornerOf(std::uint64_t key) {
  const auto along = [key](unsigned axis) {
    return static_cast<float>(static_cast<std::int64_t>(key >> (kAxisBits * axis) & kAxisMask) -
                              kMiddle);
  };
  return {along(0), along(1), along(2)};
}

/// The points of a voxel as they come.
struct Sum {
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< in voxels, from its corner
  float intensity = 0.0F;
  float count = 0.0F;

  void Add(const CloudPoint& point, const Eigen::Vector3f& corner) {
    offset += point.position * kVoxelsPerMetre - corner;
    const bool counts = point.intensity > 0.0F && std::isfinite(point.intensity);
    intensity += counts ? point.intensity : 0.0F;
    count += 1.0F;
  }
  unsigned char Part() const {
    std::uint32_t part = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const float in_parts = std::clamp(kParts * offset(axis) / count, 0.0F, kParts - 1.0F);
      part = part << kPartBits | static_cast<std::uint32_t>(in_parts);
    }
    return static_cast<unsigned char>(part);
  }
  unsigned char Shade(float greatest) const {
    if (!(greatest > 0.0F)) return 0;
    const float share = std::min(1.0F, intensity / count / greatest);
    return static_cast<unsigned char>(std::lround(kFullIntensity * share));
  }
};

/// Voxels from one key to the next, in columns.
struct Columns {
  std::string steps;
  std::string parts;
  std::string shades;

  void Add(std::uint64_t step, const Sum& sum, float greatest) {
    constexpr std::uint64_t kMore = std::uint64_t{1} << kStepBits;
    for (; step >= kMore; step >>= kStepBits) {
      steps += static_cast<char>((step & (kMore - 1)) | kMore);
    }
    steps += static_cast<char>(step);
    parts += static_cast<char>(sum.Part());
    shades += static_cast<char>(sum.Shade(greatest));
  }
};

Columns ColumnsOf(const CloudPoints& points, float greatest) {
  Columns columns;
  const std::vector<std::uint64_t> keys = SortedKeys(points);
  for (std::string* column : {&columns.steps, &columns.parts, &columns.shades}) {
    column->reserve(keys.size());
  }
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < keys.size() && columns.parts.size() < kMostVoxels;) {
    const std::uint64_t key = keys[i] >> kPlaceBits;
    const Eigen::Vector3f corner = CornerOf(key);
    Sum sum;
    for (; i < keys.size() && keys[i] >> kPlaceBits == key; ++i) {
      sum.Add(points[keys[i] & kPlaceMask], corner);
    }
    columns.Add(key - before, sum, greatest);
    before = key;
  }
  return columns;
}

float GreatestIntensity(const CloudPoints& points) {
  float greatest = 0.0F;
  for (const CloudPoint& point : points) {
    const float intensity = point.intensity;
    if (intensity > greatest && intensity < std::numeric_limits<float>::infinity()) {
      greatest = intensity;
    }
  }
  return greatest;
}

/// The columns of so many voxels; empty when there is anything else in the bytes.
std::optional<std::string> UnpackColumns(std::string_view packed, std::size_t voxels) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  // Both of what is unknown and of what is no frame are larger than any of ours.
  if (size < voxels * (1 + kBytesBesideStep) || size > voxels * (kLongestStep + kBytesBesideStep)) {
    return std::nullopt;
  }
  std::string columns(static_cast<std::size_t>(size), '\0');
  const std::size_t unpacked =
      ZSTD_decompress(columns.data(), columns.size(), packed.data(), packed.size());
  if (ZSTD_isError(unpacked) != 0 || unpacked != columns.size()) return std::nullopt;
  return columns;
}

/// Takes a step from the front; empty where there is none.
std::optional<std::uint64_t> TakeStep(std::string_view* steps) {
  std::uint64_t step = 0;
  for (std::size_t i = 0; i < kLongestStep && i < steps->size(); ++i) {
    const auto byte = static_cast<unsigned char>((*steps)[i]);
    constexpr unsigned char kMore = 1U << kStepBits;
    step |= std::uint64_t{static_cast<unsigned char>(byte & (kMore - 1U))} << (kStepBits * i);
    if ((byte & kMore) != 0) continue;
    steps->remove_prefix(i + 1);
    return step;
  }
  return std::nullopt;
}

CloudPoint PointOf(std::uint64_t key, unsigned char part, unsigned char shade, float greatest) {
  CloudPoint point;
  point.position = CornerOf(key);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned of_axis = part >> (kPartBits * static_cast<unsigned>(axis)) & kPartMask;
    point.position(axis) += (static_cast<float>(of_axis) + 0.5F) / kParts;
  }
  point.position /= kVoxelsPerMetre;
  point.intensity = static_cast<float>(shade) / kFullIntensity * greatest;
  return point;
}

bool IsSound(const Head& head) {
  const bool is_placed = std::all_of(head.lidar.begin(), head.lidar.end(),
                                     [](float number) { return std::isfinite(number); });
  return is_placed && !std::isinf(head.ceiling) && std::isfinite(head.intensity) &&
         head.intensity >= 0.0F && head.voxels <= kMostVoxels;
}

}  // namespace

std::string PackCloud(const LevelledCloud& cloud) {
  Head head;
  Eigen::Map<Eigen::Vector3f>(head.lidar.data()) = cloud.lidar.cast<float>();
  head.ceiling = cloud.ceiling_m ? static_cast<float>(*cloud.ceiling_m)
                                 : std::numeric_limits<float>::quiet_NaN();
  head.intensity = GreatestIntensity(cloud.points);
  const Columns columns = ColumnsOf(cloud.points, head.intensity);
  head.voxels = static_cast<std::uint32_t>(columns.parts.size());
  const std::string all = columns.steps + columns.parts + columns.shades;
  std::string bytes(sizeof(head) + ZSTD_compressBound(all.size()), '\0');
  std::memcpy(bytes.data(), &head, sizeof(head));
  const std::size_t packed = ZSTD_compress(bytes.data() + sizeof(head), bytes.size() - sizeof(head),
                                           all.data(), all.size(), kZstdLevel);
  if (ZSTD_isError(packed) != 0) throw std::bad_alloc();  // there is room for all else
  bytes.resize(sizeof(head) + packed);
  bytes.shrink_to_fit();
  return bytes;
}

std::optional<LevelledCloud> UnpackCloud(std::string_view bytes) {
  Head head;
  if (bytes.size() < sizeof(head)) return std::nullopt;
  std::memcpy(&head, bytes.data(), sizeof(head));
  if (!IsSound(head)) return std::nullopt;
  const auto columns = UnpackColumns(bytes.substr(sizeof(head)), head.voxels);
  if (!columns) return std::nullopt;
  const std::size_t beside = columns->size() - kBytesBesideStep * head.voxels;
  std::string_view steps = std::string_view(*columns).substr(0, beside);
  const std::string_view parts = std::string_view(*columns).substr(beside, head.voxels);
  const std::string_view shades = std::string_view(*columns).substr(beside + head.voxels);
  LevelledCloud cloud;
  cloud.lidar = Eigen::Map<const Eigen::Vector3f>(head.lidar.data()).cast<double>();
  if (!std::isnan(head.ceiling)) cloud.ceiling_m = head.ceiling;
  cloud.points.reserve(head.voxels);
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < head.voxels; ++i) {
    const std::optional<std::uint64_t> step = TakeStep(&steps);
    if (!step || *step >= kKeys - key) return std::nullopt;
    key += *step;
    cloud.points.push_back(PointOf(key, static_cast<unsigned char>(parts[i]),
                                   static_cast<unsigned char>(shades[i]), head.intensity));
  }
  if (!steps.empty()) return std::nullopt;
  return cloud;
}

}  // namespace masked_mapper
