// SPDX-License-Identifier: BSD-3-Clause
// Shortest ways in a graph whose edges have lengths (Dijkstra).
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace masked_mapper {

class LengthGraph {
 public:
  explicit LengthGraph(std::size_t nodes) : neighbours_(nodes) {}
  /// Walked both ways; the length is not negative.
  void AddEdge(std::size_t a, std::size_t b, double length);

  struct Start {
    std::size_t node = 0;
    double length = 0.0;  ///< already walked there
  };
  /// Metres from the nearest of the starts to every node; infinite beyond `limit` and where no way
  /// leads.
  std::vector<double> LengthsFrom(const std::vector<Start>& starts,
                                  double limit = std::numeric_limits<double>::infinity()) const;

 private:
  std::vector<std::vector<std::pair<std::size_t, double>>> neighbours_;
};

}  // namespace masked_mapper
