// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/mapping/configuration.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "masked_mapper/log/input_error.hpp"
#include "masked_mapper/mapping/option_table.hpp"

namespace masked_mapper {
namespace {

/// Ours ends after a few kilobytes; a file of this size is something else.
constexpr std::uintmax_t kLargestFile = 1 << 20;
/// Deeper than any section; an alias to its own parent would go on for ever.
constexpr int kDeepest = 8;

class Reader {
 public:
  Reader(std::string name, Options& options) : name_(std::move(name)), options_(options) {}

  void ReadSection(const YAML::Node& section, const std::string& prefix, int depth) {
    for (const auto& item : section) {
      const std::string where = name_ + ":" + std::to_string(item.first.Mark().line + 1);
      if (!item.first.IsScalar()) throw InputError(where + ": a key must be a word");
      const std::string key = prefix + item.first.Scalar();
      // Also an emptied section: the same name twice would leave one of the two unread.
      if (!seen_.insert(key).second) throw InputError(where + ": " + key + " is given twice");
      if (item.second.IsNull()) continue;  // its lines are commented out
      if (item.second.IsMap() && depth < kDeepest) {
        ReadSection(item.second, key + ".", depth + 1);
      } else if (item.second.IsScalar()) {
        SetOption(where, key, item.second.Scalar(), options_);
      } else {
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
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) throw InputError(name + ": holds more than one YAML document");
    for (const YAML::Node& root : documents) {
      if (!root.IsMap() && !root.IsNull()) {
        throw InputError(name + ":1: expected sections of `key: value` lines");
      }
      Reader(name, changed).ReadSection(root, "", 0);
    }
  } catch (const YAML::Exception& error) {
    throw InputError(name + ":" + std::to_string(error.mark.line + 1) +
                     ": not valid YAML: " + error.msg);
  }
  options = changed;
}

void ReadConfiguration(const std::string& path, Options& options) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such configuration file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kLargestFile) throw InputError(path + ": too large for a configuration");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path + ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  ReadConfigurationText(path, text, options);
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
