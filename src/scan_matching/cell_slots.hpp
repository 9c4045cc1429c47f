// SPDX-License-Identifier: BSD-3-Clause
// Which cells of a square grid are in use: each has a slot, 0, 1, 2, ... in the order in which they
// were asked for. Kept in tiles, so that a grid of which little is used costs little to begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace masked_mapper {

class CellSlots {
 public:
  struct Cell {
    int column = -1;
    int row = -1;
  };

  /// A grid of `width` x `width` cells, none of them in use.
  explicit CellSlots(int width);

  int width() const { return width_; }
  /// Slots in use.
  std::size_t size() const { return cell_of_slot_.size(); }

  bool Contains(Cell cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < width_ && cell.row < width_;
  }

  /// Of a cell within the grid; -1: not in use.
  std::int32_t SlotOf(Cell cell) const {
    const std::int32_t tile = tiles_at_[TileOf(cell)];
    return tile < 0 ? -1 : slots_[IndexOf(tile, cell)];
  }

  Cell CellOf(std::size_t slot) const {
    return {cell_of_slot_[slot] % width_, cell_of_slot_[slot] / width_};
  }

  /// The slot of a cell within the grid, the next one where it had none.
  std::size_t Use(Cell cell);

  /// Row by row, of each slot: all that there is to be kept of it.
  const std::vector<std::int32_t>& cells() const { return cell_of_slot_; }
  /// Becomes what was kept; false, and in no defined state, where that is of no such grid.
  bool Take(const std::vector<std::int32_t>& cells);

 private:
  static constexpr unsigned kTile = 8;  ///< cells to a side of a tile

  // Divided as unsigned numbers, by shifts.
  std::size_t TileOf(Cell cell) const {
    return static_cast<std::size_t>(static_cast<unsigned>(cell.row) / kTile) * tiles_ +
           static_cast<unsigned>(cell.column) / kTile;
  }
  static std::size_t IndexOf(std::int32_t tile, Cell cell) {
    return (static_cast<std::size_t>(tile) * kTile + static_cast<unsigned>(cell.row) % kTile) *
               kTile +
           static_cast<unsigned>(cell.column) % kTile;
  }

  int width_;
  std::size_t tiles_;                   ///< to a side of the grid
  std::vector<std::int32_t> tiles_at_;  ///< row by row; -1: nothing in use
  std::vector<std::int32_t> slots_;     ///< of each tile, row by row; -1: not in use
  std::vector<std::int32_t> cell_of_slot_;
};

}  // namespace masked_mapper
