// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/masks/mask_registry.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "combined_masks.hpp"
#include "eccentricity_mask.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "never_always_masks.hpp"
#include "openings_mask.hpp"
#include "sparse_mask.hpp"

namespace masked_mapper {
namespace {

using Factories = std::map<std::string, MaskFactory, std::less<>>;
using Parts = std::vector<std::unique_ptr<Mask>>;

/// Deeper expressions are refused, so that no input can exhaust the stack.
constexpr int kMaxDepth = 32;
/// A wrong name is quoted up to here.
constexpr std::size_t kMaxQuoted = 40;

constexpr std::string_view kCombinations[] = {"all", "any", "not", "sparse"};

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

[[noreturn]] void FailUnknown(std::string_view name) {
  std::vector<std::string> known = RegisteredMasks();
  known.insert(known.end(), std::begin(kCombinations), std::end(kCombinations));
  std::string hint = DidYouMean(name, known);
  if (hint.empty()) {
    for (const std::string& mask : RegisteredMasks()) hint += (hint.empty() ? "" : ", ") + mask;
    hint = " (there are " + hint + ", and any(...), all(...), not(...), sparse(...) of them)";
  }
  const std::string quoted(name.substr(0, kMaxQuoted));
  throw InputError("unknown mask `" + quoted + (quoted.size() < name.size() ? "..." : "") + "`" +
                   hint);
}

/// expression := name | ("any" | "all") "(" expression { "," expression } ")"
///             | ("not" | "sparse") "(" expression ")"
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
    if (factory == Registry().end()) FailUnknown(name);
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
    const bool takes_one = name == "not" || name == "sparse";
    if (takes_one && parts.size() != 1) Fail("`" + name + "` takes one part");
    ++next_;
    SkipSpace();
    return parts;
  }

  std::unique_ptr<Mask> Combine(std::string_view name, Parts parts) const {
    if (name == "any") return std::make_unique<AnyMask>(std::move(parts));
    if (name == "all") return std::make_unique<AllMask>(std::move(parts));
    if (name == "not") return std::make_unique<NotMask>(std::move(parts));
    return std::make_unique<SparseMask>(std::move(parts), options_.sparse);
  }

  char Peek() const { return next_ < text_.size() ? text_[next_] : '\0'; }

  void SkipSpace() {
    while (next_ < text_.size() && (text_[next_] == ' ' || text_[next_] == '\t')) ++next_;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError("mask expression, character " + std::to_string(next_ + 1) + ": " + what);
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
