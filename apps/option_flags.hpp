// SPDX-License-Identifier: BSD-3-Clause
// The flags --config and --set, which several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "masked_mapper/options/options.hpp"

namespace masked_mapper {

struct OptionFlags {
  std::string configuration;          ///< path; empty: none
  std::vector<std::string> settings;  ///< key=value, later ones win
};

void AddOptionFlags(CLI::App& command, OptionFlags& flags);

/// Defaults, then the file, then the settings. Throws InputError.
Options ReadOptions(const OptionFlags& flags);

}  // namespace masked_mapper
