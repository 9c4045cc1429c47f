// SPDX-License-Identifier: BSD-3-Clause
// Lines over the cells of a grid, in fixed point.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace masked_mapper {

// Beams are traced in fixed point: integers do not depend on where a band of rows cuts a beam, so
// the counts are the same however the work is shared out.
using Fixed = std::int64_t;
constexpr int kFractionBits = 16;  // of a cell
constexpr Fixed kHalfCell = Fixed{1} << (kFractionBits - 1);

struct FixedPoint {
  Fixed x = 0;
  Fixed y = 0;
};

struct FixedBox {
  FixedPoint low{std::numeric_limits<Fixed>::max(), std::numeric_limits<Fixed>::max()};
  FixedPoint high{std::numeric_limits<Fixed>::min(), std::numeric_limits<Fixed>::min()};

  bool empty() const { return low.x > high.x; }
  void Add(const FixedPoint& point) {
    low.x = std::min(low.x, point.x);
    low.y = std::min(low.y, point.y);
    high.x = std::max(high.x, point.x);
    high.y = std::max(high.y, point.y);
  }
  void Add(const FixedBox& box) {
    if (box.empty()) return;
    Add(box.low);
    Add(box.high);
  }
};

inline int CellOf(Fixed coordinate) { return static_cast<int>(coordinate >> kFractionBits); }

// The lower edge of the cell that holds the coordinate.
inline Fixed EdgeOf(Fixed coordinate) { return coordinate - (coordinate & (2 * kHalfCell - 1)); }

// The line from `start` to `end`, sampled where it crosses the middle of each column (of each row
// when it is steep) strictly between the two: y = y0 + (step - step0) * slope, 32 fraction bits.
struct SampledLine {
  int first = 0;  // samples [first, last)
  int last = 0;
  Fixed minor_at_first = 0;
  Fixed slope = 0;

  int MinorCell(int step) const {
    return static_cast<int>((minor_at_first + slope * (step - first)) >> 32);
  }
};

inline SampledLine SampleLine(Fixed major_start, Fixed minor_start, Fixed major_end,
                              Fixed minor_end) {
  SampledLine line;
  line.first = std::min(CellOf(major_start), CellOf(major_end)) + 1;
  line.last = std::max(CellOf(major_start), CellOf(major_end));
  if (line.first >= line.last) return line;
  line.slope = ((minor_end - minor_start) * (Fixed{1} << 32)) / (major_end - major_start);
  const Fixed to_first = (Fixed{line.first} << kFractionBits) + kHalfCell - major_start;
  line.minor_at_first =
      (minor_start << (32 - kFractionBits)) + ((line.slope * to_first) >> kFractionBits);
  return line;
}

// The samples whose minor cell is in [low, high); the minor cell is monotone along the line.
inline void ClipMinor(int low, int high, SampledLine* line) {
  const auto first_where = [line](const auto& condition) {
    int begin = line->first;
    int end = line->last;
    while (begin < end) {
      const int middle = begin + (end - begin) / 2;
      if (condition(line->MinorCell(middle))) {
        end = middle;
      } else {
        begin = middle + 1;
      }
    }
    return begin;
  };
  const bool rising = line->slope >= 0;
  const int first = rising ? first_where([low](int cell) { return cell >= low; })
                           : first_where([high](int cell) { return cell < high; });
  const int last = rising ? first_where([high](int cell) { return cell >= high; })
                          : first_where([low](int cell) { return cell < low; });
  line->minor_at_first += line->slope * (first - line->first);
  line->first = first;
  line->last = last;
}

}  // namespace masked_mapper
