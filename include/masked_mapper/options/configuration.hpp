// SPDX-License-Identifier: BSD-3-Clause
// Configuration files: YAML whose keys are those of the option table, nested (`matcher:` /
// `min_score:`) or dotted (`matcher.min_score:`). None is ever required.
#pragma once

#include <string>

#include "masked_mapper/options/options.hpp"

namespace masked_mapper {

/// Changes the options that the file names. Throws InputError with file, line and key for what
/// cannot be read, does not parse, is unknown, given twice, of the wrong type or out of range.
void ReadConfiguration(const std::string& path, Options& options);

/// The same from text; `name` stands for the file in messages.
void ReadConfigurationText(const std::string& name, const std::string& text, Options& options);

/// A configuration file with every option at its value in `options`, and its meaning beside it.
std::string ConfigurationText(const Options& options);

}  // namespace masked_mapper
