// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/rendering/space_votes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <future>
#include <limits>
#include <utility>

#include "cloud_rays.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"
#include "surface_patch.hpp"

namespace masked_mapper {
namespace {

constexpr double kMargin = 1.2;     // voxels about a surface of which its rays say nothing
constexpr double kFlat = 2.0;       // voxels within which a return is of floor or ceiling
constexpr double kLongest = 40.0;   // voxels that a ray is cut at the most
constexpr double kThickness = 0.6;  // voxels, standard deviation across what is one surface
constexpr int kPatchBits = 2;       // a patch is four voxels a side
constexpr std::uint8_t kFull = std::numeric_limits<std::uint8_t>::max();

constexpr std::size_t kPatches = kSpaceBlockVoxels >> (3 * kPatchBits);
constexpr std::size_t kCastAtOnce = 8;  // clouds

/// Of the voxels of a block in which anything was hit.
struct Surface {
  std::array<std::uint8_t, kSpaceBlockVoxels> hits{};
  std::array<SurfacePatch, kPatches> patches{};
};

struct Votes {
  VoxelIndex at{};
  std::array<std::uint8_t, kSpaceBlockVoxels> passes{};
  std::unique_ptr<Surface> surface;
};

std::size_t PatchOf(std::size_t place) {
  constexpr std::size_t kPart = (std::size_t{1} << (kSpaceBlockBits - kPatchBits)) - 1;
  const std::size_t x = place >> kPatchBits & kPart;
  const std::size_t y = place >> (kSpaceBlockBits + kPatchBits) & kPart;
  const std::size_t z = place >> (2 * kSpaceBlockBits + kPatchBits) & kPart;
  return (z * (kPart + 1) + y) * (kPart + 1) + x;
}

/// The bits of every byte, the lowest first.
using Eight = std::array<std::uint8_t, 8>;
constexpr std::array<Eight, 256> BitsOfBytes() {
  std::array<Eight, 256> bits_of{};
  for (std::size_t byte = 0; byte < bits_of.size(); ++byte) {
    for (std::size_t i = 0; i < 8; ++i) bits_of[byte][i] = byte >> i & 1U;
  }
  return bits_of;
}
constexpr std::array<Eight, 256> kBitsOf = BitsOfBytes();

/// Nothing of a point that is nowhere, or too far from the origin.
template <typename Point>
std::optional<VoxelIndex> VoxelAt(const Point& point, double side) {
  VoxelIndex voxel{};
  for (int axis = 0; axis < 3; ++axis) {
    const double in_voxels = static_cast<double>(point(axis)) / side;
    if (!(std::abs(in_voxels) <= kFarthestVoxel)) return std::nullopt;
    const auto whole = static_cast<std::int32_t>(in_voxels);  // floor() is a call
    voxel[static_cast<std::size_t>(axis)] = whole - (whole > in_voxels ? 1 : 0);
  }
  return voxel;
}

/// One more of `votes`; full counts are halved, both of a voxel, so that they stay in proportion.
/// Null: there are no others.
void Vote(std::uint8_t* votes, std::uint8_t* others) {
  if (*votes == kFull) {
    *votes /= 2;
    if (others != nullptr) *others = static_cast<std::uint8_t>((*others + 1) / 2);
  }
  ++*votes;
}

/// The same for eight in a row, of those whose bit is set.
void VoteForEight(std::uint8_t bits, std::uint8_t* votes, std::uint8_t* others) {
  std::uint64_t eight = 0;
  std::uint64_t more = 0;
  std::memcpy(&eight, votes, sizeof eight);
  std::memcpy(&more, kBitsOf[bits].data(), sizeof more);
  constexpr std::uint64_t kEachOne = 0x0101010101010101;
  constexpr std::uint64_t kEachTop = 0x8080808080808080;
  const bool is_any_full = ((~eight - kEachOne) & eight & kEachTop) != 0;
  if (!is_any_full) {
    eight += more;
    std::memcpy(votes, &eight, sizeof eight);
    return;
  }
  for (unsigned i = 0; i < 8; ++i) {
    if ((bits >> i & 1U) != 0) Vote(votes + i, others == nullptr ? nullptr : others + i);
  }
}

}  // namespace

struct SpaceVotes::Cloud {
  Eigen::Vector3d lidar;
  std::vector<Eigen::Vector3f> ends;  ///< one per voxel that was hit
  double floor_m = 0.0;
  std::optional<double> ceiling_m;
};

/// Clouds whose rays are cast, behind what goes on meanwhile.
class SpaceVotes::Casting {
 public:
  struct Job {
    Cloud cloud;
    std::vector<Eigen::Vector3d> far_ends;  ///< of its rays, in voxels
    CloudRays rays;
  };

  explicit Casting(const SpaceVoteOptions& options)
      : jobs_(kCastAtOnce), side_(options.resolution_m), threads_(options.threads) {}

  Job& job(std::size_t i) { return jobs_[i]; }

  /// The first so many jobs.
  void Begin(std::size_t count) {
    in_work_ = std::async(threads_ > 1 ? std::launch::async : std::launch::deferred, [this, count] {
      ForEach(count, threads_, [this](std::size_t i) { Cast(jobs_[i]); });
      return count;
    });
  }
  /// How many jobs are done; 0 if none was begun.
  std::size_t End() {
    if (!in_work_.valid()) return 0;
    const std::size_t count = in_work_.get();
    bytes_ = 0;
    for (const Job& job : jobs_) bytes_ += job.rays.bytes();
    return count;
  }

  std::size_t bytes() const { return bytes_; }

 private:
  void Cast(Job& job) const {
    job.rays.Begin(job.cloud.lidar / side_);
    for (const Eigen::Vector3f& end : job.cloud.ends) job.rays.Hit(*VoxelAt(end, side_));
    for (const Eigen::Vector3d& end : job.far_ends) job.rays.Pass(end);
  }

  std::vector<Job> jobs_;
  double side_;
  int threads_;
  std::size_t bytes_ = 0;             ///< of the jobs that were done last
  std::future<std::size_t> in_work_;  ///< the last, since it uses the others
};

class SpaceVotes::Volume {
 public:
  explicit Volume(const SpaceVoteOptions& options) : options_(options) {}

  Votes& BlockAt(const VoxelIndex& at) {
    if (last_ != nullptr && IsSame(last_->at, at)) return *last_;
    const auto [found, is_new] = index_.try_emplace(KeyOfPlace(at), blocks_.size());
    if (is_new) {
      blocks_.emplace_back();
      blocks_.back().at = at;
    }
    last_ = &blocks_[found->second];
    return *last_;
  }

  void AddToSurface(const Eigen::Vector3f& end, const VoxelIndex& voxel) {
    Votes& block = BlockAt(BlockOf(voxel));
    SurfaceIn(block).patches[PatchOf(PlaceInBlock(voxel))].Add(InBlock(end, block));
  }

  void VoteForHit(const VoxelIndex& voxel) {
    Votes& block = BlockAt(BlockOf(voxel));
    const std::size_t place = PlaceInBlock(voxel);
    Vote(&SurfaceIn(block).hits[place], &block.passes[place]);
  }

  void VoteForPassed(const CloudRays& rays);

  /// How much before its end a ray is cut, m.
  double CutOf(const Cloud& cloud, const Eigen::Vector3f& end, const Eigen::Vector3d& direction) {
    const double side = options_.resolution_m;
    const double z = static_cast<double>(end.z());
    double steep = 1.0;
    const bool is_level = std::abs(z - cloud.floor_m) < kFlat * side ||
                          (cloud.ceiling_m && std::abs(z - *cloud.ceiling_m) < kFlat * side);
    if (is_level) steep = std::abs(direction.z());
    const std::optional<VoxelIndex> voxel = VoxelAt(end, side);
    Votes& block = BlockAt(BlockOf(*voxel));
    SurfacePatch& patch = SurfaceIn(block).patches[PatchOf(PlaceInBlock(*voxel))];
    const auto normal = patch.Normal(static_cast<float>(kThickness * side));
    if (normal) steep = std::min(steep, std::abs(direction.dot(normal->cast<double>())));
    return std::min(kMargin / std::max(steep, 1e-6), kLongest) * side;
  }

  std::vector<Eigen::Vector3d> FarEndsOf(const Cloud& cloud) {
    std::vector<Eigen::Vector3d> far_ends;
    if (!VoxelAt(cloud.lidar, options_.resolution_m)) return far_ends;
    far_ends.reserve(cloud.ends.size());
    for (const Eigen::Vector3f& end : cloud.ends) {
      const Eigen::Vector3d ray = end.cast<double>() - cloud.lidar;
      const double range = ray.norm();
      if (!(range > 0.0)) continue;
      const Eigen::Vector3d direction = ray / range;
      const double length = range - CutOf(cloud, end, direction);
      if (!(length > 0.0)) continue;
      far_ends.emplace_back((cloud.lidar + length * direction) / options_.resolution_m);
    }
    return far_ends;
  }

  std::size_t bytes() const { return blocks_.size() * sizeof(Votes) + surfaces_ * sizeof(Surface); }

  SpaceStates States() const {
    std::vector<SpaceBlock> counted;
    counted.reserve(blocks_.size());
    for (const Votes& block : blocks_) {
      counted.emplace_back();
      counted.back().at = block.at;
      for (std::size_t i = 0; i < kSpaceBlockVoxels; ++i) {
        const std::uint8_t hits = block.surface ? block.surface->hits[i] : 0;
        counted.back().cells[i] = StateOf(hits, block.passes[i]);
      }
    }
    return {options_.resolution_m, std::move(counted)};
  }

 private:
  Surface& SurfaceIn(Votes& block) {
    if (!block.surface) {
      block.surface = std::make_unique<Surface>();
      ++surfaces_;
    }
    return *block.surface;
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
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::deque<Votes> blocks_;  ///< which stay where they are
  Votes* last_ = nullptr;
  std::size_t surfaces_ = 0;
};

// What a cloud hit it did not pass, though rays of its own did: those that saw the rim beside it.
void SpaceVotes::Volume::VoteForPassed(const CloudRays& rays) {
  for (const CloudRays::Block& passed : rays.blocks()) {
    Votes* block = nullptr;
    for (std::size_t word = 0; word < passed.passed.size(); ++word) {
      std::uint64_t left = passed.passed[word] & ~passed.hit[word];
      if (left != 0 && block == nullptr) block = &BlockAt(passed.at);
      for (std::size_t place = 64 * word; left != 0; place += 8, left >>= 8) {
        std::uint8_t* const hits = block->surface ? &block->surface->hits[place] : nullptr;
        VoteForEight(static_cast<std::uint8_t>(left), &block->passes[place], hits);
      }
    }
  }
}

SpaceVotes::SpaceVotes(const SpaceVoteOptions& options)
    : options_(options),
      volume_(std::make_unique<Volume>(options)),
      added_(std::make_unique<CloudRays>()),
      casting_(std::make_unique<Casting>(options)) {}
SpaceVotes::~SpaceVotes() = default;
SpaceVotes::SpaceVotes(SpaceVotes&&) noexcept = default;

void SpaceVotes::Add(const Eigen::Vector3d& lidar, std::vector<Eigen::Vector3f> ends,
                     double floor_m, const std::optional<double>& ceiling_m) {
  added_->Begin(lidar / options_.resolution_m);
  const auto is_known = [&](const Eigen::Vector3f& end) {
    const std::optional<VoxelIndex> voxel = VoxelAt(end, options_.resolution_m);
    if (!voxel) return true;
    volume_->AddToSurface(end, *voxel);
    if (!added_->Hit(*voxel)) return true;
    volume_->VoteForHit(*voxel);
    return false;
  };
  ends.erase(std::remove_if(ends.begin(), ends.end(), is_known), ends.end());
  ends.shrink_to_fit();
  waiting_.push_back({lidar, std::move(ends), floor_m, ceiling_m});
  if (waiting_.size() >= options_.clouds_ahead + kCastAtOnce) CastFirst();
}

// What each cloud saw is one vote. They are taken in their order, at the same places between what
// is added, be there one thread or many: the same bytes.
void SpaceVotes::CastFirst() {
  TakeVotes();
  const std::size_t count = std::min(kCastAtOnce, waiting_.size());
  for (std::size_t i = 0; i < count; ++i) {
    Casting::Job& job = casting_->job(i);
    job.cloud = std::move(waiting_.front());
    job.far_ends = volume_->FarEndsOf(job.cloud);
    waiting_.pop_front();
  }
  casting_->Begin(count);
}

void SpaceVotes::TakeVotes() {
  const std::size_t count = casting_->End();
  for (std::size_t i = 0; i < count; ++i) volume_->VoteForPassed(casting_->job(i).rays);
}

std::size_t SpaceVotes::bytes() const {
  std::size_t waiting = 0;
  for (const Cloud& cloud : waiting_) waiting += cloud.ends.size() * sizeof(Eigen::Vector3f);
  return volume_->bytes() + casting_->bytes() + waiting;
}

SpaceStates SpaceVotes::Count() {
  while (!waiting_.empty()) CastFirst();
  TakeVotes();
  SpaceStates states = volume_->States();
  volume_ = std::make_unique<Volume>(options_);
  return states;
}

}  // namespace masked_mapper
