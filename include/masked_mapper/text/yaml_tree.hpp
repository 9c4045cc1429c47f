// SPDX-License-Identifier: BSD-3-Clause
// The one door to YAML: a text as a tree of plain values that know their line.
#pragma once

#include <string>
#include <vector>

namespace masked_mapper {

struct YamlTree {
  enum class Kind { kEmpty, kValue, kList, kSection };

  struct Entry;

  Kind kind = Kind::kEmpty;
  std::size_t line = 1;
  std::string value;           ///< of a value
  std::vector<YamlTree> list;  ///< of a list
  std::vector<Entry> entries;  ///< of a section, in order, names as often as given
};

struct YamlTree::Entry {
  std::string key;
  std::size_t line = 1;
  YamlTree tree;
};

/// Throws InputError with `name` and line for what is not valid, several documents, keys that are
/// no words, and trees so deep or large that aliases must have made them.
YamlTree ParseYaml(const std::string& name, const std::string& text);

/// The text of a small file; `what` is for messages ("configuration"). Throws InputError when it
/// cannot be read or is too large to be one.
std::string ReadSmallFile(const std::string& path, const std::string& what);

}  // namespace masked_mapper
