// SPDX-License-Identifier: BSD-3-Clause
#include "bag_sequence.hpp"

#include <algorithm>
#include <tuple>

#include "open_bag.hpp"

namespace masked_mapper {

BagSequence::BagSequence(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    parts_.push_back({OpenBag(path), {}});
    Part& part = parts_.back();
    for (const auto& [id, connection] : part.bag->Connections()) NumberOf(&part, id);
  }
}

std::uint32_t BagSequence::NumberOf(Part* part, std::uint32_t connection) {
  const auto known = part->numbers.find(connection);
  if (known != part->numbers.end()) return known->second;
  const BagConnection& wanted = part->bag->Connections().at(connection);
  const auto same = std::find_if(connections_.begin(), connections_.end(), [&](const auto& other) {
    return std::tie(wanted.topic, wanted.type, wanted.md5sum) ==
           std::tie(other.second.topic, other.second.type, other.second.md5sum);
  });
  const auto number =
      same != connections_.end() ? same->first : static_cast<std::uint32_t>(connections_.size());
  connections_.emplace(number, wanted);
  part->numbers.emplace(connection, number);
  return number;
}

std::optional<BagMessage> BagSequence::Next() {
  for (; part_ < parts_.size(); ++part_) {
    Part& part = parts_[part_];
    if (std::optional<BagMessage> message = part.bag->Next()) {
      message->connection = NumberOf(&part, message->connection);
      return message;
    }
  }
  return std::nullopt;
}

void BagSequence::Rewind() {
  for (Part& part : parts_) part.bag->Rewind();
  part_ = 0;
}

bool BagSequence::IsIndexed() const {
  return std::all_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.bag->IsIndexed(); });
}

bool BagSequence::Truncated() const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.bag->Truncated(); });
}

std::uint64_t BagSequence::Damaged() const {
  std::uint64_t damaged = 0;
  for (const Part& part : parts_) damaged += part.bag->Damaged();
  return damaged;
}

double BagSequence::Progress() const {
  const double within = part_ < parts_.size() ? parts_[part_].bag->Progress() : 0.0;
  return (static_cast<double>(part_) + within) / static_cast<double>(parts_.size());
}

}  // namespace masked_mapper
