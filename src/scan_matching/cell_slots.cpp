// SPDX-License-Identifier: BSD-3-Clause
#include "cell_slots.hpp"

namespace masked_mapper {

CellSlots::CellSlots(int width)
    : width_(width),
      tiles_((static_cast<std::size_t>(width) + kTile - 1) / kTile),
      tiles_at_(tiles_ * tiles_, -1) {}

std::size_t CellSlots::Use(Cell cell) {
  constexpr std::size_t kCellsOfTile = std::size_t{kTile} * kTile;
  std::int32_t& tile = tiles_at_[TileOf(cell)];
  if (tile < 0) {
    tile = static_cast<std::int32_t>(slots_.size() / kCellsOfTile);
    slots_.resize(slots_.size() + kCellsOfTile, -1);
  }
  std::int32_t& slot = slots_[IndexOf(tile, cell)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(cell_of_slot_.size());
    cell_of_slot_.push_back(cell.row * width_ + cell.column);
  }
  return static_cast<std::size_t>(slot);
}

bool CellSlots::Take(const std::vector<std::int32_t>& cells) {
  *this = CellSlots(width_);
  for (const std::int32_t index : cells) {
    const Cell cell{index % width_, index / width_};
    if (index < 0 || !Contains(cell) || SlotOf(cell) >= 0) return false;
    Use(cell);
  }
  return true;
}

}  // namespace masked_mapper
