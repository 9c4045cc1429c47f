// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/masks/mask_registry.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "masked_mapper/masks/combined_masks.hpp"
#include "masked_mapper/masks/never_always_masks.hpp"

namespace masked_mapper {
namespace {

using Factories = std::map<std::string, MaskFactory, std::less<>>;
using Parts = std::vector<std::unique_ptr<Mask>>;

/// Deeper expressions are refused, so that no input can exhaust the stack.
constexpr int kMaxDepth = 32;
/// A wrong name is quoted up to here.
constexpr std::size_t kMaxQuoted = 40;

constexpr std::string_view kCombinations[] = {"all", "any", "not"};

bool IsCombination(std::string_view name) {
  return std::find(std::begin(kCombinations), std::end(kCombinations), name) !=
         std::end(kCombinations);
}

bool IsNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

/// The built-in masks are named here and not by registration objects of their own files: a linker
/// drops such objects from a static library.
Factories BuiltIn() {
  return {
      {"never", [](const MaskOptions&) { return std::make_unique<NeverMask>(); }},
      {"always", [](const MaskOptions&) { return std::make_unique<AlwaysMask>(); }},
      {"eccentricity",
       [](const MaskOptions& options) {
         return std::make_unique<EccentricityMask>(options.eccentricity);
       }},
      {"openings",
       [](const MaskOptions& options) { return std::make_unique<OpeningsMask>(options.openings); }},
  };
}

/// Made on first use, so that a registration at namespace scope finds it whatever the order.
Factories& Registry() {
  static Factories factories = BuiltIn();
  return factories;
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replace}));
    }
  }
  return row.back();
}

/// The end of an error message about a name that does not exist.
std::string Suggestion(std::string_view unknown) {
  std::vector<std::string> names = RegisteredMasks();
  names.insert(names.end(), std::begin(kCombinations), std::end(kCombinations));
  std::sort(names.begin(), names.end());
  const auto nearest =
      std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
        return EditDistance(unknown, a) < EditDistance(unknown, b);
      });
  if (2 * EditDistance(unknown, *nearest) <= unknown.size()) {
    return " (did you mean `" + *nearest + "`?)";
  }
  std::string list;
  for (const std::string& name : RegisteredMasks()) list += (list.empty() ? "" : ", ") + name;
  return " (there are " + list + ", and any(...), all(...), not(...) of them)";
}

/// expression := name | ("any" | "all") "(" expression { "," expression } ")" | "not" "("
/// expression ")"
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const MaskOptions& options)
      : text_(text), options_(options) {}

  std::unique_ptr<Mask> ParseAll() {
    std::unique_ptr<Mask> mask = ParseExpression(0);
    if (next_ < text_.size()) Fail("expected the end");
    return mask;
  }

 private:
  std::unique_ptr<Mask> ParseExpression(int depth) {
    if (depth > kMaxDepth) Fail("nested deeper than " + std::to_string(kMaxDepth) + " levels");
    SkipSpace();
    const std::size_t begin = next_;
    next_ = std::min(text_.find_first_of("(), \t", begin), text_.size());
    const std::string_view name = text_.substr(begin, next_ - begin);
    if (name.empty()) Fail("expected the name of a mask");
    SkipSpace();
    if (IsCombination(name)) return Combine(name, ParseParts(name, depth));

    const auto factory = Registry().find(name);
    if (factory == Registry().end()) {
      const std::string_view quoted = name.substr(0, kMaxQuoted);
      throw std::invalid_argument("unknown mask `" + std::string(quoted) +
                                  (quoted.size() < name.size() ? "..." : "") + "`" +
                                  (quoted.size() < name.size() ? "" : Suggestion(name)));
    }
    if (Peek() == '(') Fail("`" + std::string(name) + "` takes no parts");
    return factory->second(options_);
  }

  Parts ParseParts(std::string_view combination, int depth) {
    const std::string name(combination);
    if (Peek() != '(') Fail("expected `(` after `" + name + "`");
    Parts parts;
    do {
      ++next_;
      parts.push_back(ParseExpression(depth + 1));
    } while (Peek() == ',');
    if (Peek() != ')') Fail("expected `,` or `)`");
    if (name == "not" && parts.size() != 1) Fail("`not` takes one part");
    ++next_;
    SkipSpace();
    return parts;
  }

  static std::unique_ptr<Mask> Combine(std::string_view name, Parts parts) {
    if (name == "any") return std::make_unique<AnyMask>(std::move(parts));
    if (name == "all") return std::make_unique<AllMask>(std::move(parts));
    return std::make_unique<NotMask>(std::move(parts));
  }

  char Peek() const { return next_ < text_.size() ? text_[next_] : '\0'; }

  void SkipSpace() {
    while (next_ < text_.size() && (text_[next_] == ' ' || text_[next_] == '\t')) ++next_;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw std::invalid_argument("mask expression, character " + std::to_string(next_ + 1) + ": " +
                                what);
  }

  std::string_view text_;
  const MaskOptions& options_;
  std::size_t next_ = 0;
};

}  // namespace

bool RegisterMask(const std::string& name, MaskFactory factory) {
  if (name.empty() || !std::all_of(name.begin(), name.end(), IsNameCharacter) ||
      IsCombination(name)) {
    throw std::logic_error("`" + name + "` cannot be the name of a mask");
  }
  if (!Registry().emplace(name, std::move(factory)).second) {
    throw std::logic_error("a mask `" + name + "` is registered already");
  }
  return true;
}

std::vector<std::string> RegisteredMasks() {
  std::vector<std::string> names;
  for (const auto& [name, factory] : Registry()) names.push_back(name);
  return names;
}

std::unique_ptr<Mask> MakeMask(const std::string& expression, const MaskOptions& options) {
  return ExpressionParser(expression, options).ParseAll();
}

}  // namespace masked_mapper
