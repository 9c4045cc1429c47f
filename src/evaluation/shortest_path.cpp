// SPDX-License-Identifier: BSD-3-Clause
#include "shortest_path.hpp"

#include <cassert>
#include <functional>
#include <queue>

namespace masked_mapper {

void LengthGraph::AddEdge(std::size_t a, std::size_t b, double length) {
  assert(length >= 0.0);
  neighbours_.at(a).emplace_back(b, length);
  neighbours_.at(b).emplace_back(a, length);
}

std::vector<double> LengthGraph::LengthsFrom(const std::vector<Start>& starts, double limit) const {
  std::vector<double> lengths(neighbours_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](std::size_t node, double length) {
    if (length > limit || !(length < lengths.at(node))) return;
    lengths[node] = length;
    open.emplace(length, node);
  };
  for (const Start& start : starts) reach(start.node, start.length);
  while (!open.empty()) {
    const auto [length, node] = open.top();
    open.pop();
    if (length > lengths[node]) continue;
    for (const auto& [next, step] : neighbours_[node]) reach(next, length + step);
  }
  return lengths;
}

}  // namespace masked_mapper
