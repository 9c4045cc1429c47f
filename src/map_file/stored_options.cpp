// SPDX-License-Identifier: BSD-3-Clause
#include "stored_options.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// Of so many a line says the names; a map of old times may hold hundreds.
constexpr std::size_t kNamed = 12;

/// What is no key of any program is not printed as it is.
std::string Printable(std::string key) {
  constexpr std::size_t kLongest = 60;
  if (key.size() > kLongest) key = key.substr(0, kLongest) + "...";
  std::replace_if(
      key.begin(), key.end(), [](char c) { return c <= ' ' || c > '~'; }, '?');
  return key;
}

}  // namespace

StoredOptions::StoredOptions() {
  for (const OptionEntry& entry : OptionTable(options_)) known_.insert(entry.key);
}

void StoredOptions::Add(std::string key, const std::string& value) {
  if (known_.count(key) == 0) {
    unknown_.push_back(Printable(std::move(key)));
    return;
  }
  try {
    SetOption("stored option", key, value, options_);
  } catch (const InputError& error) {
    refused_.emplace_back(error.what());
  }
}

Options StoredOptions::Take(std::vector<std::string>& left_aside) {
  if (!unknown_.empty()) {
    std::string line = "made with options that this program does not have, left aside: ";
    for (std::size_t i = 0; i < std::min(unknown_.size(), kNamed); ++i) {
      line += (i == 0 ? "" : ", ") + unknown_[i];
    }
    if (unknown_.size() > kNamed) {
      line += " and " + std::to_string(unknown_.size() - kNamed) + " more";
    }
    left_aside.push_back(std::move(line));
  }
  for (std::size_t i = 0; i < std::min(refused_.size(), kNamed); ++i) {
    left_aside.push_back("made with an option that cannot be so any more, the default stands: " +
                         refused_[i]);
  }
  try {
    CheckOptions(options_);
  } catch (const InputError& error) {
    left_aside.push_back("made with options that contradict each other, all defaults stand: " +
                         std::string(error.what()));
    options_ = Options();
  }
  return std::move(options_);
}

}  // namespace masked_mapper
