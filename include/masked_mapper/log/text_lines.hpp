// SPDX-License-Identifier: BSD-3-Clause
// A text file line by line, plain or packed as logs are, read strictly.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

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

}  // namespace masked_mapper
