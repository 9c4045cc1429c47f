// SPDX-License-Identifier: BSD-3-Clause
// Text files of this room's kinds, read line by line and strictly.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace masked_mapper {

/// A place in a text file, for what is said of it.
struct FileLine {
  const std::string& path;
  std::size_t number;  ///< from 1

  [[noreturn]] void Fail(const std::string& reason) const;  ///< throws InputError
};

/// Calls for each line, without its line break. Throws InputError when the file cannot be read, is
/// cut off, or has a line beyond any reason.
void ForEachLine(const std::string& path,
                 const std::function<void(std::string_view, const FileLine&)>& on_line);

/// The words of a line, parted by blanks and tabs.
std::vector<std::string_view> WordsOf(std::string_view line);

/// A finite number and nothing behind it, else InputError.
double NumberIn(std::string_view word, const FileLine& line);

}  // namespace masked_mapper
