// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/space_votes.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <utility>

#include "surface_patch.hpp"

namespace masked_mapper {
namespace {

constexpr double kMargin = 1.2;     // voxels about a surface of which its rays say nothing
constexpr double kFlat = 2.0;       // voxels within which a return is of floor or ceiling
constexpr double kLongest = 40.0;   // voxels that a ray is cut at the most
constexpr double kThickness = 0.6;  // voxels, standard deviation across what is one surface
constexpr std::int32_t kFarthest = 1 << 19;  // voxels from the origin
constexpr int kPatchBits = 2;                // a patch is four voxels a side
constexpr std::uint8_t kFull = std::numeric_limits<std::uint8_t>::max();

using Bits = std::bitset<kSpaceBlockVoxels>;
constexpr std::size_t kPatches = kSpaceBlockVoxels >> (3 * kPatchBits);

/// Votes of a block, and the marks of the cloud at work.
struct Votes {
  VoxelIndex at{};
  std::uint32_t marked_by = 0;
  std::array<std::uint8_t, kSpaceBlockVoxels> hits{};
  std::array<std::uint8_t, kSpaceBlockVoxels> passes{};
  Bits hit;
  Bits passed;
  std::unique_ptr<std::array<SurfacePatch, kPatches>> patches;

  void MarkFor(std::uint32_t cloud) {
    if (marked_by == cloud) return;
    marked_by = cloud;
    hit.reset();
    passed.reset();
  }
};

std::size_t PatchOf(std::size_t place) {
  constexpr std::size_t kPart = (std::size_t{1} << (kSpaceBlockBits - kPatchBits)) - 1;
  const std::size_t x = place >> kPatchBits & kPart;
  const std::size_t y = place >> (kSpaceBlockBits + kPatchBits) & kPart;
  const std::size_t z = place >> (2 * kSpaceBlockBits + kPatchBits) & kPart;
  return (z * (kPart + 1) + y) * (kPart + 1) + x;
}

/// One more of `votes`; full counts are halved, both of a voxel, so that they stay in proportion.
void Vote(std::uint8_t* votes, std::uint8_t* others) {
  if (*votes == kFull) {
    *votes /= 2;
    *others = static_cast<std::uint8_t>((*others + 1) / 2);
  }
  ++*votes;
}

VoxelIndex BlockOf(const VoxelIndex& voxel) {
  return {voxel[0] >> kSpaceBlockBits, voxel[1] >> kSpaceBlockBits, voxel[2] >> kSpaceBlockBits};
}

}  // namespace

struct SpaceVotes::Cloud {
  Eigen::Vector3d lidar;
  std::vector<Eigen::Vector3f> ends;  ///< one per voxel that was hit
  double floor_m = 0.0;
  std::optional<double> ceiling_m;
};

class SpaceVotes::Volume {
 public:
  explicit Volume(const SpaceVoteOptions& options) : options_(options) {}

  void NextCloud() {
    ++cloud_;
    last_ = nullptr;  // whose marks are of the one before
  }

  Votes& BlockAt(const VoxelIndex& at) {
    if (last_ != nullptr && last_->at == at) return *last_;
    const auto [found, is_new] = index_.emplace(KeyOfPlace(at), blocks_.size());
    if (is_new) {
      blocks_.emplace_back();
      blocks_.back().at = at;
    }
    last_ = &blocks_[found->second];
    last_->MarkFor(cloud_);
    return *last_;
  }

  std::optional<VoxelIndex> VoxelOf(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d in_voxels = point / options_.resolution_m;
    if (!in_voxels.allFinite() || in_voxels.cwiseAbs().maxCoeff() > kFarthest) return std::nullopt;
    VoxelIndex voxel{};
    for (int axis = 0; axis < 3; ++axis) {
      voxel[static_cast<std::size_t>(axis)] =
          static_cast<std::int32_t>(std::floor(in_voxels(axis)));
    }
    return voxel;
  }

  /// Whether this is the first hit of the voxel by the cloud.
  bool Hit(const Eigen::Vector3f& end, bool counts) {
    const std::optional<VoxelIndex> voxel = VoxelOf(end.cast<double>());
    if (!voxel) return false;
    Votes& block = BlockAt(BlockOf(*voxel));
    const std::size_t place = PlaceInBlock(*voxel);
    if (counts) PatchIn(block, place).Add(InBlock(end, block));
    if (block.hit[place]) return false;
    block.hit.set(place);
    if (counts) Vote(&block.hits[place], &block.passes[place]);
    return true;
  }

  /// The way of a ray through the voxels, from the lidar towards the end, `length` m long.
  void Pass(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double length);

  /// How much before its end a ray is cut, m.
  double CutOf(const Cloud& cloud, const Eigen::Vector3f& end, const Eigen::Vector3d& direction) {
    const double side = options_.resolution_m;
    const double z = static_cast<double>(end.z());
    double steep = 1.0;
    const bool is_level = std::abs(z - cloud.floor_m) < kFlat * side ||
                          (cloud.ceiling_m && std::abs(z - *cloud.ceiling_m) < kFlat * side);
    if (is_level) steep = std::abs(direction.z());
    const std::optional<VoxelIndex> voxel = VoxelOf(end.cast<double>());
    Votes& block = BlockAt(BlockOf(*voxel));
    const auto normal =
        PatchIn(block, PlaceInBlock(*voxel)).Normal(static_cast<float>(kThickness * side));
    if (normal) steep = std::min(steep, std::abs(direction.dot(normal->cast<double>())));
    return std::min(kMargin / std::max(steep, 1e-6), kLongest) * side;
  }

  std::size_t bytes() const { return blocks_.size() * sizeof(Votes) + patches_ * kPatchesSize; }

  SpaceStates States() const {
    std::vector<SpaceBlock> counted;
    counted.reserve(blocks_.size());
    for (const Votes& block : blocks_) {
      counted.emplace_back();
      counted.back().at = block.at;
      for (std::size_t i = 0; i < kSpaceBlockVoxels; ++i) {
        counted.back().cells[i] = StateOf(block.hits[i], block.passes[i]);
      }
    }
    return {options_.resolution_m, std::move(counted)};
  }

 private:
  static constexpr std::size_t kPatchesSize = kPatches * sizeof(SurfacePatch);

  SurfacePatch& PatchIn(Votes& block, std::size_t place) {
    if (!block.patches) {
      block.patches = std::make_unique<std::array<SurfacePatch, kPatches>>();
      ++patches_;
    }
    return (*block.patches)[PatchOf(place)];
  }

  Eigen::Vector3f InBlock(const Eigen::Vector3f& end, const Votes& block) const {
    const Eigen::Vector3d corner(block.at[0], block.at[1], block.at[2]);
    return (end.cast<double>() - options_.resolution_m * kSpaceBlockSide * corner).cast<float>();
  }

  Cell StateOf(std::uint8_t hits, std::uint8_t passes) const {
    const int votes = hits + passes;
    const bool is_there = hits >= options_.occupied_ratio * votes;
    if (hits >= options_.least_hits && is_there) return Cell::kOccupied;
    return passes > 0 && !is_there ? Cell::kFree : Cell::kUnknown;
  }

  SpaceVoteOptions options_;
  std::uint32_t cloud_ = 0;
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::deque<Votes> blocks_;  ///< which stay where they are
  Votes* last_ = nullptr;
  std::size_t patches_ = 0;
};

void SpaceVotes::Volume::Pass(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                              double length) {
  const std::optional<VoxelIndex> start = VoxelOf(from);
  if (!start || !(length > 0.0)) return;
  const double side = options_.resolution_m;
  VoxelIndex voxel = *start;
  std::array<std::int32_t, 3> step{};
  std::array<double, 3> next{};  // m along the ray, to the next wall of each axis
  std::array<double, 3> apart{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along = direction(static_cast<int>(axis));
    step[axis] = along > 0.0 ? 1 : -1;
    const double wall = side * (voxel[axis] + (along > 0.0 ? 1 : 0));
    constexpr double kNever = std::numeric_limits<double>::infinity();
    next[axis] = along == 0.0 ? kNever : (wall - from(static_cast<int>(axis))) / along;
    apart[axis] = along == 0.0 ? kNever : side / std::abs(along);
  }
  Votes* block = &BlockAt(BlockOf(voxel));
  while (true) {
    const std::size_t place = PlaceInBlock(voxel);
    if (!block->hit[place] && !block->passed[place]) {
      block->passed.set(place);
      Vote(&block->passes[place], &block->hits[place]);
    }
    const std::size_t axis =
        next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (!(next[axis] < length)) return;
    voxel[axis] += step[axis];
    next[axis] += apart[axis];
    if (voxel[axis] >> kSpaceBlockBits != block->at[axis]) block = &BlockAt(BlockOf(voxel));
  }
}

SpaceVotes::SpaceVotes(const SpaceVoteOptions& options)
    : options_(options), volume_(std::make_unique<Volume>(options)) {}
SpaceVotes::~SpaceVotes() = default;
SpaceVotes::SpaceVotes(SpaceVotes&&) noexcept = default;

void SpaceVotes::Add(const Eigen::Vector3d& lidar, std::vector<Eigen::Vector3f> ends,
                     double floor_m, const std::optional<double>& ceiling_m) {
  volume_->NextCloud();
  const auto known = [this](const Eigen::Vector3f& end) { return !volume_->Hit(end, true); };
  ends.erase(std::remove_if(ends.begin(), ends.end(), known), ends.end());
  ends.shrink_to_fit();
  waiting_.push_back({lidar, std::move(ends), floor_m, ceiling_m});
  if (waiting_.size() > options_.clouds_ahead) CastFirst();
}

void SpaceVotes::CastFirst() {
  const Cloud cloud = std::move(waiting_.front());
  waiting_.pop_front();
  volume_->NextCloud();
  for (const Eigen::Vector3f& end : cloud.ends) volume_->Hit(end, false);
  for (const Eigen::Vector3f& end : cloud.ends) {
    const Eigen::Vector3d ray = end.cast<double>() - cloud.lidar;
    const double range = ray.norm();
    if (!(range > 0.0)) continue;
    const Eigen::Vector3d direction = ray / range;
    volume_->Pass(cloud.lidar, direction, range - volume_->CutOf(cloud, end, direction));
  }
}

std::size_t SpaceVotes::bytes() const {
  std::size_t waiting = 0;
  for (const Cloud& cloud : waiting_) waiting += cloud.ends.size() * sizeof(Eigen::Vector3f);
  return volume_->bytes() + waiting;
}

SpaceStates SpaceVotes::Count() {
  while (!waiting_.empty()) CastFirst();
  SpaceStates states = volume_->States();
  volume_ = std::make_unique<Volume>(options_);
  return states;
}

}  // namespace masked_mapper
