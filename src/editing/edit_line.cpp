// SPDX-License-Identifier: BSD-3-Clause
#include "edit_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

EditLine::EditLine(const std::string& name, const YamlTree& tree) : name_(name), line_(tree.line) {
  if (tree.kind != YamlTree::Kind::kSection || tree.entries.size() != 1) {
    Fail("expected one edit, such as `- forbid_closure: {from: 90.0, to: 14.0}`");
  }
  const YamlTree::Entry& entry = tree.entries.front();
  line_ = entry.line;
  what_ = entry.key;
  if (entry.tree.kind != YamlTree::Kind::kSection) Fail(what_ + " needs its fields");
  for (const YamlTree::Entry& field : entry.tree.entries) {
    if (!fields_.emplace(field.key, &field.tree).second) Fail(field.key + " is given twice");
  }
}

void EditLine::Fail(const std::string& message) const {
  throw InputError(name_ + ":" + std::to_string(line_) + ": " + message);
}

std::string EditLine::Word(const std::string& field) {
  const YamlTree& tree = Take(field);
  if (tree.kind != YamlTree::Kind::kValue || tree.value.empty()) {
    Fail(what_ + ": " + field + " must be a word");
  }
  return tree.value;
}

std::vector<double> EditLine::Numbers(const std::string& field, std::size_t count) {
  const YamlTree& tree = Take(field);
  if (tree.kind != YamlTree::Kind::kList || tree.list.size() != count) {
    Fail(what_ + ": " + field + " must be a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> numbers;
  for (const YamlTree& item : tree.list) numbers.push_back(NumberOf(item, field));
  return numbers;
}

std::vector<Eigen::Vector2d> EditLine::Points(const std::string& field) {
  const YamlTree& tree = Take(field);
  std::vector<Eigen::Vector2d> points;
  for (const YamlTree& item : tree.list) {
    if (item.kind != YamlTree::Kind::kList || item.list.size() != 2) break;
    points.emplace_back(NumberOf(item.list[0], field), NumberOf(item.list[1], field));
  }
  if (tree.kind != YamlTree::Kind::kList || points.size() != tree.list.size()) {
    Fail(what_ + ": " + field + " must be a list of points [x, y]");
  }
  return points;
}

EditLine::FloorPoint EditLine::PointOnFloor(const std::string& field) {
  const YamlTree& tree = Take(field);
  if (tree.kind != YamlTree::Kind::kList || tree.list.size() != 3 ||
      tree.list.front().kind != YamlTree::Kind::kValue) {
    Fail(what_ + ": " + field + " must be [floor, x, y]");
  }
  return {tree.list[0].value, {NumberOf(tree.list[1], field), NumberOf(tree.list[2], field)}};
}

std::vector<std::string> EditLine::FieldNames() const {
  std::vector<std::string> names;
  for (const auto& [field, tree] : fields_) names.push_back(field);
  return names;
}

void EditLine::RequireAllTaken() const {
  for (const auto& [field, tree] : fields_) {
    if (std::find(taken_.begin(), taken_.end(), field) == taken_.end()) {
      Fail(what_ + " has no field `" + field + "`");
    }
  }
}

const YamlTree& EditLine::Take(const std::string& field) {
  const auto found = fields_.find(field);
  if (found == fields_.end()) Fail(what_ + " needs `" + field + "`");
  taken_.push_back(field);
  return *found->second;
}

double EditLine::NumberOf(const YamlTree& tree, const std::string& field) const {
  const char* begin = tree.value.data();
  const char* const end = begin + tree.value.size();
  if (begin != end && *begin == '+') ++begin;  // as YAML allows
  double number = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (tree.kind != YamlTree::Kind::kValue || error != std::errc() || stop != end ||
      !std::isfinite(number)) {
    Fail(what_ + ": " + field + " must be a number");
  }
  return number;
}

}  // namespace masked_mapper
