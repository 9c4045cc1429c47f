// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map/closure.hpp"

#include <array>

namespace masked_mapper {
namespace {

// By value of the enumeration.
constexpr std::array<const char*, 4> kStates = {"rejected_score", "hypothesis", "validated",
                                                "audited_out"};
constexpr std::array<const char*, 10> kReasons = {
    "score below the minimum",
    "does not fit the surroundings of the older node",
    "the place looks alike along a line",
    "too few votes",
    "enough votes",
    "fits the optimised map",
    "disagrees with the optimised map",
    "too few others tie the drives",
    "added by hand",
    "forbidden by hand",
};

template <class Enum, std::size_t kCount>
std::optional<Enum> Find(const std::array<const char*, kCount>& names, std::string_view name) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (names[i] == name) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

const char* Name(ClosureState state) { return kStates.at(static_cast<std::size_t>(state)); }

std::optional<ClosureState> ClosureStateOf(std::string_view name) {
  return Find<ClosureState>(kStates, name);
}

const char* Name(ClosureReason reason) { return kReasons.at(static_cast<std::size_t>(reason)); }

std::optional<ClosureReason> ClosureReasonOf(std::string_view name) {
  return Find<ClosureReason>(kReasons, name);
}

EdgeId AddClosureEdge(const std::vector<Closure>& closures, ClosureId id, PoseGraph& graph) {
  const Closure& closure = closures.at(static_cast<std::size_t>(id));
  return graph.AddEdge(
      {closure.older, closure.newer, closure.T_older_newer, EdgeKind::kClosure, id});
}

}  // namespace masked_mapper
