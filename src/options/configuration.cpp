// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/option_table.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "masked_mapper/text/input_error.hpp"
#include "masked_mapper/text/yaml_tree.hpp"

namespace masked_mapper {
namespace {

class Reader {
 public:
  Reader(std::string name, Options& options) : name_(std::move(name)), options_(options) {}

  void ReadSection(const YamlTree& section, const std::string& prefix) {
    for (const YamlTree::Entry& entry : section.entries) {
      const std::string where = name_ + ":" + std::to_string(entry.line);
      const std::string key = prefix + entry.key;
      // Also an emptied section: the same name twice would leave one of the two unread.
      if (!seen_.insert(key).second) throw InputError(where + ": " + key + " is given twice");
      switch (entry.tree.kind) {
        case YamlTree::Kind::kEmpty:  // its lines are commented out
          break;
        case YamlTree::Kind::kSection:
          ReadSection(entry.tree, key + ".");
          break;
        case YamlTree::Kind::kValue:
          SetOption(where, key, entry.tree.value, options_);
          break;
        case YamlTree::Kind::kList:
          throw InputError(where + ": " + key + " must be one value, or a section of options");
      }
    }
  }

 private:
  std::string name_;
  Options& options_;
  std::set<std::string> seen_;
};

/// The sections of a key: `masks.openings.` of `masks.openings.min_turn_deg`.
std::string SectionOf(const std::string& key) { return key.substr(0, key.rfind('.') + 1); }

/// Lines that open those sections of a key which are not open yet.
std::string SectionHeads(const std::string& section, const std::string& open) {
  std::string heads;
  std::string indent;
  for (std::size_t start = 0; start < section.size();) {
    const std::size_t end = section.find('.', start) + 1;
    if (open.compare(0, end, section, 0, end) != 0) {
      heads += (start == 0 ? "\n" : "") + indent + section.substr(start, end - start - 1) + ":\n";
    }
    indent += "  ";
    start = end;
  }
  return heads;
}

}  // namespace

void ReadConfigurationText(const std::string& name, const std::string& text, Options& options) {
  // All or nothing: a file with a mistake on its last line changes no option.
  Options changed = options;
  const YamlTree tree = ParseYaml(name, text);
  if (tree.kind != YamlTree::Kind::kSection && tree.kind != YamlTree::Kind::kEmpty) {
    throw InputError(name + ":1: expected sections of `key: value` lines");
  }
  Reader(name, changed).ReadSection(tree, "");
  options = changed;
}

void ReadConfiguration(const std::string& path, Options& options) {
  ReadConfigurationText(path, ReadSmallFile(path, "configuration"), options);
}

std::string ConfigurationText(const Options& options) {
  constexpr std::size_t kCommentColumn = 38;
  constexpr std::size_t kWidth = 100;
  Options copy = options;
  std::string text;
  std::string open;
  for (const OptionEntry& entry : OptionTable(copy)) {
    const std::string section = SectionOf(entry.key);
    text += SectionHeads(section, open);
    open = section;
    const auto depth = static_cast<std::size_t>(std::count(section.begin(), section.end(), '.'));
    std::string line(2 * depth, ' ');
    line += entry.key.substr(section.size()) + ": " + ValueText(entry);
    line.resize(std::max(line.size() + 2, kCommentColumn), ' ');
    line += "# " + entry.help;
    const std::string range = "[" + RangeText(entry) + "]";
    const bool fits = line.size() + 1 + range.size() <= kWidth;
    text += line + (fits ? " " : "\n" + std::string(kCommentColumn, ' ') + "# ") + range + "\n";
  }
  return text;
}

}  // namespace masked_mapper
