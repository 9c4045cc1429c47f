// SPDX-License-Identifier: BSD-3-Clause
// One line of a file of edits: its name, and its fields, each of which must be asked for.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "masked_mapper/text/yaml_tree.hpp"

namespace masked_mapper {

class EditLine {
 public:
  /// `name` is the file's. Throws InputError with file and line, as all below, when `tree` is no
  /// edit.
  EditLine(const std::string& name, const YamlTree& tree);

  const std::string& what() const { return what_; }
  [[noreturn]] void Fail(const std::string& message) const;

  bool Has(const std::string& field) const { return fields_.count(field) != 0; }
  std::string Word(const std::string& field);
  double Number(const std::string& field) { return NumberOf(Take(field), field); }
  std::vector<double> Numbers(const std::string& field, std::size_t count);
  /// A list of lists of two numbers, metres.
  std::vector<Eigen::Vector2d> Points(const std::string& field);
  struct FloorPoint {
    std::string label;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
  };
  /// [label, x, y]
  FloorPoint PointOnFloor(const std::string& field);
  std::vector<std::string> FieldNames() const;
  /// Fails for a field that nobody asked for.
  void RequireAllTaken() const;

 private:
  const YamlTree& Take(const std::string& field);
  double NumberOf(const YamlTree& tree, const std::string& field) const;

  std::string name_;
  std::size_t line_;
  std::string what_;
  std::map<std::string, const YamlTree*> fields_;
  std::vector<std::string> taken_;
};

}  // namespace masked_mapper
