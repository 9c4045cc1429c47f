// SPDX-License-Identifier: BSD-3-Clause
#include "distance_field.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kFar = 1e18;

/// min over j of (i - j)^2 + heights[j] for every i, by the lower envelope of these parabolas
/// (Felzenszwalb and Huttenlocher 2012).
class Envelope {
 public:
  explicit Envelope(std::size_t size) : apex_(size), start_(size + 1), result_(size) {}

  const std::vector<double>& Of(const std::vector<double>& heights) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      if (heights[i] >= kFar) continue;
      double begins = -kFar;
      while (count > 0) {
        begins = Crossing(apex_[count - 1], i, heights);
        if (begins > start_[count - 1]) break;
        --count;
        begins = -kFar;
      }
      apex_[count] = i;
      start_[count] = begins;
      ++count;
    }
    std::size_t at = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      if (count == 0) {
        result_[i] = kFar;
        continue;
      }
      while (at + 1 < count && start_[at + 1] < static_cast<double>(i)) ++at;
      const double off = static_cast<double>(i) - static_cast<double>(apex_[at]);
      result_[i] = off * off + heights[apex_[at]];
    }
    return result_;
  }

 private:
  static double Crossing(std::size_t left, std::size_t right, const std::vector<double>& heights) {
    const auto l = static_cast<double>(left);
    const auto r = static_cast<double>(right);
    return (heights[right] + r * r - heights[left] - l * l) / (2.0 * (r - l));
  }

  std::vector<std::size_t> apex_;
  std::vector<double> start_;
  std::vector<double> result_;
};

}  // namespace

std::vector<float> DistanceField(const std::vector<std::uint8_t>& marked, int width) {
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows = columns == 0 ? 0 : marked.size() / columns;
  // First up and down each column, in one sweep over the rows each way; squares are exact in float
  // up to a side of 4096 cells, and their roots to a thousandth of a cell beyond.
  std::vector<float> field(marked.size(), kNoneMarked);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (marked[i] != 0) {
      field[i] = 0.0F;
    } else if (i >= columns) {
      field[i] = std::min(kNoneMarked, field[i - columns] + 1.0F);
    }
  }
  for (std::size_t i = marked.size(); i-- > columns;) {
    field[i - columns] = std::min(field[i - columns], field[i] + 1.0F);
  }
  std::vector<double> heights(columns);
  Envelope envelope(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    float* const line = field.data() + row * columns;
    for (std::size_t i = 0; i < columns; ++i) {
      heights[i] = line[i] >= kNoneMarked ? kFar : static_cast<double>(line[i]) * line[i];
    }
    const std::vector<double>& squares = envelope.Of(heights);
    for (std::size_t i = 0; i < columns; ++i) {
      line[i] = squares[i] >= kFar ? kNoneMarked : static_cast<float>(std::sqrt(squares[i]));
    }
  }
  return field;
}

}  // namespace masked_mapper
