// SPDX-License-Identifier: BSD-3-Clause
// Words and numbers of the lines of this room's text files, read strictly.
#pragma once

#include <string_view>
#include <vector>

#include "masked_mapper/log/text_lines.hpp"

namespace masked_mapper {

/// The words of a line, parted by blanks and tabs.
std::vector<std::string_view> WordsOf(std::string_view line);

/// A finite number and nothing behind it, else InputError.
double NumberIn(std::string_view word, const FileLine& line);

}  // namespace masked_mapper
