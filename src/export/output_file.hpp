// SPDX-License-Identifier: BSD-3-Clause
// A file being written, every write of which is checked: a full disk must not pass for a finished
// map.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace masked_mapper {

class OutputFile {
 public:
  /// Makes the file, or empties it. Throws std::runtime_error, as all below, when that fails.
  explicit OutputFile(std::filesystem::path path);

  void Write(std::string_view bytes);
  /// Must be called at the end; what was written may fail as late as here.
  void Close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void Fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// All of a file at once.
void WriteFile(const std::filesystem::path& path, std::string_view bytes);

}  // namespace masked_mapper
