// SPDX-License-Identifier: BSD-3-Clause
// Every option once, by name: its field, what it may be, what it means. Configuration files,
// `--set`, the listing that the program prints and summary.json are all read from this table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "masked_mapper/options/options.hpp"

namespace masked_mapper {

/// One of several names; the field is an enumeration with values in the order of the names.
struct Choice {
  std::vector<std::string> names;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};

struct OptionEntry {
  std::string key;  ///< the path of the field in Options: `matcher.min_score`
  std::variant<double*, int*, std::size_t*, bool*, std::string*, Choice> field;
  double min = 0.0;  ///< smallest and largest value allowed; of numbers alone
  double max = 0.0;
  std::string help;  ///< unit and meaning, one line
};

/// The table, with its fields in `options`; options of one section stand together.
std::vector<OptionEntry> OptionTable(Options& options);

/// The value as configuration files have it; reading it back gives the same value.
std::string ValueText(const OptionEntry& entry);

/// "0 to 1", "true or false", "odometry, scans or fused".
std::string RangeText(const OptionEntry& entry);

/// Sets one option from text. Throws InputError, with `where` in front, for an unknown key (naming
/// the nearest) and for a value of the wrong type or out of range.
void SetOption(const std::string& where, const std::string& key, const std::string& value,
               Options& options);

/// The same from `key=value`, as `--set` has it.
void SetOption(const std::string& assignment, Options& options);

/// Options that contradict each other (a least above its most): InputError naming both keys.
void CheckOptions(const Options& options);

using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

/// Key and value of every option that may change the result: not the number of threads.
std::vector<std::pair<std::string, OptionValue>> OptionValues(const Options& options);

// Configuration files: YAML whose keys are those of the option table, nested (`matcher:` /
// `min_score:`) or dotted (`matcher.min_score:`). None is ever required.

/// Changes the options that the file names. Throws InputError with file, line and key for what
/// cannot be read, does not parse, is unknown, given twice, of the wrong type or out of range.
void ReadConfiguration(const std::string& path, Options& options);

/// The same from text; `name` stands for the file in messages.
void ReadConfigurationText(const std::string& name, const std::string& text, Options& options);

/// A configuration file with every option at its value in `options`, and its meaning beside it.
std::string ConfigurationText(const Options& options);

}  // namespace masked_mapper
