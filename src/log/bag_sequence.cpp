// SPDX-License-Identifier: BSD-3-Clause
#include "bag_sequence.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "open_bag.hpp"

namespace masked_mapper {

BagSequence::BagSequence(const std::vector<std::string>& paths, Order order) {
  end_time_ = 0.0;
  for (const std::string& path : paths) parts_.push_back(Survey(path));
  if (order == Order::kAsGiven) return;
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return a.first_time < b.first_time; });
}

BagSequence::Part BagSequence::Survey(const std::string& path) {
  const std::unique_ptr<RosBag> bag = OpenBag(path);
  const std::optional<BagMessage> first = bag->Next();
  // Of a part without messages it does not matter.
  Part part{path, first ? first->time : std::numeric_limits<double>::max(), {}};
  if (!bag->IsIndexed()) {
    while (bag->Next()) {
    }  // the connections are wherever they are
  }
  const std::optional<double> end = bag->EndTime();
  end_time_ = end && end_time_ ? std::optional<double>(std::max(*end, *end_time_)) : std::nullopt;
  for (const auto& [id, connection] : bag->Connections()) {
    part.numbers.emplace(id, NumberOf(connection));
  }
  return part;
}

std::uint32_t BagSequence::NumberOf(const BagConnection& connection) {
  const auto same =
      std::find_if(connections_.begin(), connections_.end(), [&connection](const auto& other) {
        return std::tie(connection.topic, connection.type, connection.md5sum) ==
               std::tie(other.second.topic, other.second.type, other.second.md5sum);
      });
  if (same != connections_.end()) return same->first;
  const auto number = static_cast<std::uint32_t>(connections_.size());
  connections_.emplace(number, connection);
  return number;
}

std::optional<BagMessage> BagSequence::Next() {
  while (part_ < parts_.size()) {
    const Part& part = parts_[part_];
    if (!open_) open_ = OpenBag(part.path);
    if (std::optional<BagMessage> message = open_->Next()) {
      message->connection = part.numbers.at(message->connection);
      return message;
    }
    ClosePart();
  }
  return std::nullopt;
}

void BagSequence::ClosePart() {
  if (damaged_ == 0 && open_->Damaged() > 0) first_damage_ = open_->FirstDamage();
  damaged_ += open_->Damaged();
  truncated_ = truncated_ || open_->Truncated();
  open_.reset();
  ++part_;
}

void BagSequence::Rewind() {
  open_.reset();
  part_ = 0;
  truncated_ = false;
  damaged_ = 0;
}

std::string BagSequence::FirstDamage() const {
  return damaged_ > 0 || !open_ ? first_damage_ : open_->FirstDamage();
}

double BagSequence::Progress() const {
  const double within = open_ ? open_->Progress() : 0.0;
  return (static_cast<double>(part_) + within) / static_cast<double>(parts_.size());
}

}  // namespace masked_mapper
