// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// Ours end after a few kilobytes; a file of this size is something else.
constexpr std::uintmax_t kLargestFile = 1 << 20;
/// Deeper than anything of ours; an alias to its own parent would go on for ever.
constexpr int kDeepest = 12;
/// Aliases of aliases double with every line.
constexpr int kMostNodes = 100000;

class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  YamlTree Convert(const YAML::Node& node, int depth) {
    YamlTree tree;
    tree.line = LineOf(node);
    if (depth > kDeepest || ++nodes_ > kMostNodes) {
      throw InputError(Where(tree.line) + "sections within sections, more than anything here has");
    }
    if (node.IsScalar()) {
      tree.kind = YamlTree::Kind::kValue;
      tree.value = node.Scalar();
    } else if (node.IsSequence()) {
      tree.kind = YamlTree::Kind::kList;
      for (const auto& item : node) tree.list.push_back(Convert(item, depth + 1));
    } else if (node.IsMap()) {
      tree.kind = YamlTree::Kind::kSection;
      for (const auto& item : node) {
        const std::size_t line = LineOf(item.first);
        if (!item.first.IsScalar()) throw InputError(Where(line) + "a key must be a word");
        tree.entries.push_back({item.first.Scalar(), line, Convert(item.second, depth + 1)});
      }
    }
    return tree;
  }

 private:
  static std::size_t LineOf(const YAML::Node& node) {
    return static_cast<std::size_t>(node.Mark().line + 1);
  }
  std::string Where(std::size_t line) const { return name_ + ":" + std::to_string(line) + ": "; }

  std::string name_;
  int nodes_ = 0;
};

/// Takes no note of anything.
class Unheard final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// Not by LoadAll: on some malformed texts that finds empty documents without end.
bool HasSecondDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Unheard unheard;
  return parser.HandleNextDocument(unheard) && parser.HandleNextDocument(unheard);
}

}  // namespace

YamlTree ParseYaml(const std::string& name, const std::string& text) {
  try {
    if (HasSecondDocument(text)) throw InputError(name + ": holds more than one YAML document");
    return Converter(name).Convert(YAML::Load(text), 0);
  } catch (const YAML::Exception& error) {
    throw InputError(name + ":" + std::to_string(error.mark.line + 1) +
                     ": not valid YAML: " + error.msg);
  }
}

std::string ReadSmallFile(const std::string& path, const std::string& what) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such " + what + " file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kLargestFile) throw InputError(path + ": too large for a " + what);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace masked_mapper
