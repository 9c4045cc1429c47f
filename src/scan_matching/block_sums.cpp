// SPDX-License-Identifier: BSD-3-Clause
#include "block_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace masked_mapper {
namespace {

constexpr int kSize = BlockSums::kSize;
constexpr std::uint32_t kMaxCount = 128;   // of points merged in one coarse cell
constexpr std::uint32_t kMaxWeight = 257;  // of points whose bytes add up within 16 bits
constexpr double kFarthest = 268435456.0;  // cells, 2^28: adding an offset cannot overflow

static_assert(LookupTable::kPadding >= kSize, "blocks are read past the table's end");

// Eight bytes or words at a time, in the compilers' own vectors: SSE2, NEON or plain code alike.
using Bytes __attribute__((vector_size(kSize))) = std::uint8_t;
using Words __attribute__((vector_size(2 * kSize))) = std::uint16_t;

// A block of offsets as vectors: one row of 8 in each, or two rows of 4.
template <int kBlock>
inline Words LoadWords(const std::uint8_t* from, std::ptrdiff_t stride) {
  Bytes bytes;
  if constexpr (kBlock == 8) {
    std::memcpy(&bytes, from, 8);
  } else {
    std::uint32_t rows[2];
    std::memcpy(&rows[0], from, 4);
    std::memcpy(&rows[1], from + stride, 4);
    std::memcpy(&bytes, rows, 8);
  }
  return __builtin_convertvector(bytes, Words);
}

// Adds up 16-bit parts, which hold points of up to kMaxWeight together, into the sums of a block of
// kBlock x kBlock offsets.
template <int kBlock>
class Accumulator {
 public:
  explicit Accumulator(const LookupTable::Level& level)
      : level_(level),
        end_x_(static_cast<std::uint32_t>(level.width + kBlock)),
        end_y_(static_cast<std::uint32_t>(level.height + kBlock)) {}

  void Add(std::int32_t left, std::int32_t bottom) {
    if (!Reaches(left, bottom)) return;
    if (++weight_ > kMaxWeight) Flush(1);
    const std::uint8_t* from = level_.data + bottom * level_.stride + left;
    for (Words& part : parts_) {
      part += LoadWords<kBlock>(from, level_.stride);
      from += kRowsPerPart * level_.stride;
    }
  }

  void Add(std::int32_t left, std::int32_t bottom, std::uint32_t count) {
    if (!Reaches(left, bottom)) return;
    weight_ += count;
    if (weight_ > kMaxWeight) Flush(count);
    const std::uint8_t* from = level_.data + bottom * level_.stride + left;
    const Words counts = Words{} + static_cast<std::uint16_t>(count);
    for (Words& part : parts_) {
      part += LoadWords<kBlock>(from, level_.stride) * counts;
      from += kRowsPerPart * level_.stride;
    }
  }

  BlockSums::Sums Total() {
    Flush(0);
    return sums_;
  }

 private:
  static constexpr int kRowsPerPart = kSize / kBlock;
  static constexpr int kParts = kBlock / kRowsPerPart;

  // Whether a block from this cell on touches anything but zeros; if so, all of it may be read.
  bool Reaches(std::int32_t left, std::int32_t bottom) const {
    return static_cast<std::uint32_t>(left + kBlock) < end_x_ &&
           static_cast<std::uint32_t>(bottom + kBlock) < end_y_;
  }

  void Flush(std::uint32_t weight) {
    for (int i = 0; i < kBlock * kBlock; ++i) {
      sums_[static_cast<std::size_t>(i / kBlock)][static_cast<std::size_t>(i % kBlock)] +=
          parts_[i / kSize][i % kSize];
    }
    for (Words& part : parts_) part = Words{};
    weight_ = weight;
  }

  const LookupTable::Level level_;
  std::uint32_t end_x_;
  std::uint32_t end_y_;
  std::uint32_t weight_ = 0;
  Words parts_[kParts] = {};
  BlockSums::Sums sums_{};
};

template <int kBlock>
BlockSums::Sums SumCells(const LookupTable::Level& level, const std::int32_t* cells_x,
                         const std::int32_t* cells_y, std::size_t count, std::int32_t x,
                         std::int32_t y) {
  Accumulator<kBlock> accumulator(level);
  for (std::size_t i = 0; i < count; ++i) accumulator.Add(cells_x[i] + x, cells_y[i] + y);
  return accumulator.Total();
}

template <int kBlock, typename Point>
BlockSums::Sums SumBinned(const LookupTable::Level& level, const Point* begin, const Point* end,
                          std::int32_t x, std::int32_t y) {
  Accumulator<kBlock> accumulator(level);
  for (; begin != end; ++begin) accumulator.Add(begin->x + x, begin->y + y, begin->count);
  return accumulator.Total();
}

}  // namespace

void CellsAtPose(const LookupTable& table, const std::vector<Eigen::Vector2d>& points_in_query,
                 const Pose2& T_reference_query, std::int32_t* __restrict cells_x,
                 std::int32_t* __restrict cells_y) {
  const double scale = 1.0 / table.resolution();
  const double c = std::cos(T_reference_query.theta) * scale;
  const double s = std::sin(T_reference_query.theta) * scale;
  const double x0 = T_reference_query.x * scale - table.level(0).x0;
  const double y0 = T_reference_query.y * scale - table.level(0).y0;
  const auto round_down = [](double value) {
    const double clamped = std::clamp(value, -kFarthest, kFarthest);
    const auto truncated = static_cast<std::int32_t>(clamped);
    return truncated - static_cast<std::int32_t>(static_cast<double>(truncated) > clamped);
  };
  const std::size_t count = points_in_query.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d& point = points_in_query[i];
    cells_x[i] = round_down(x0 + c * point.x() - s * point.y());
    cells_y[i] = round_down(y0 + s * point.x() + c * point.y());
  }
}

BlockSums::BlockSums(const LookupTable& table, const std::vector<Eigen::Vector2d>& points_in_query,
                     const SearchGrid& grid)
    : table_(table), grid_(grid), count_(points_in_query.size()) {
  const std::size_t angles = 2 * static_cast<std::size_t>(grid.half_angle) + 1;
  cells_x_.resize(angles * count_);
  cells_y_.resize(angles * count_);
  ranges_.resize(angles * static_cast<std::size_t>(table.levels()));
  Pose2 pose = grid.T_reference_query_guess;
  for (std::size_t i = 0; i < angles; ++i) {
    const auto angle = static_cast<std::int32_t>(i) - grid.half_angle;
    pose.theta = grid.T_reference_query_guess.theta + angle * grid.angle_step;
    CellsAtPose(table, points_in_query, pose, cells_x_.data() + i * count_,
                cells_y_.data() + i * count_);
  }
}

// Level 0 begins on a cell of every level, so positions relative to it may be shifted.
void BlockSums::Bin(std::int32_t angle, int level, Range* range) {
  const std::size_t first = static_cast<std::size_t>(angle + grid_.half_angle) * count_;
  const LookupTable::Level& cells = table_.level(level);
  // Cells that no offset of the grid takes to where the table is not zero add nothing.
  const std::int32_t low_x = -1 - (grid_.half_x >> level);
  const std::int32_t low_y = -1 - (grid_.half_y >> level);
  const std::int32_t high_x = cells.width - (-grid_.half_x >> level);
  const std::int32_t high_y = cells.height - (-grid_.half_y >> level);
  range->begin = binned_.size();
  binned_.resize(range->begin + count_ + 1);
  // Points come in the order of beams, so those of one cell mostly follow each other. `last` is the
  // entry being counted up; written anew for every point, since a branch would be a coin toss.
  BinnedPoint* last = binned_.data() + range->begin;
  *last = {low_x - 1, low_y - 1, 0};
  BinnedPoint current = *last;
  for (std::size_t i = first; i < first + count_; ++i) {
    const std::int32_t x = cells_x_[i] >> level;
    const std::int32_t y = cells_y_[i] >> level;
    if (x < low_x || y < low_y || x >= high_x || y >= high_y) continue;
    const bool is_same = (x == current.x) & (y == current.y) & (current.count < kMaxCount);
    last += is_same ? 0 : 1;
    current = {x, y, is_same ? current.count + 1 : 1};
    *last = current;
  }
  ++range->begin;
  range->end = static_cast<std::size_t>(last - binned_.data()) + 1;
  binned_.resize(range->end);
}

BlockSums::Sums BlockSums::At(std::int32_t angle, int level, std::int32_t x, std::int32_t y,
                              int size) {
  const std::int32_t angle_index = angle + grid_.half_angle;
  const auto slice = static_cast<std::size_t>(angle_index);
  const LookupTable::Level& cells = table_.level(level);
  if (level == 0) {
    const std::int32_t* cells_x = cells_x_.data() + slice * count_;
    const std::int32_t* cells_y = cells_y_.data() + slice * count_;
    if (size <= 4) return SumCells<4>(cells, cells_x, cells_y, count_, x, y);
    return SumCells<8>(cells, cells_x, cells_y, count_, x, y);
  }
  Range& range =
      ranges_[slice * static_cast<std::size_t>(table_.levels()) + static_cast<std::size_t>(level)];
  if (range.end == 0) Bin(angle, level, &range);
  const BinnedPoint* begin = binned_.data() + range.begin;
  const BinnedPoint* end = binned_.data() + range.end;
  if (size <= 4) return SumBinned<4>(cells, begin, end, x, y);
  return SumBinned<8>(cells, begin, end, x, y);
}

}  // namespace masked_mapper
