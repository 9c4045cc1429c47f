// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

/// Where the file that a user named is to be written, absolute. Throws InputError where it is no
/// name of a file, or something else stands there; a file is replaced.
inline std::filesystem::path FileToWrite(const std::string& name) {
  std::filesystem::path file = std::filesystem::absolute(name);
  if (!file.has_filename()) throw InputError(name + ": not the name of a file");
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file)) {
    throw InputError(name + " exists and is not a file");
  }
  return file;
}

/// A folder beside the file, gone in the end: what is written half never stands in the file's
/// place.
class AsideFolder {
 public:
  explicit AsideFolder(const std::filesystem::path& file)
      : path_(file.parent_path() /
              ("." + file.filename().string() + ".partial-" + std::to_string(getpid()))) {
    std::error_code error;
    std::filesystem::create_directory(path_, error);
    if (error) throw InputError("cannot write " + file.string() + ": " + error.message());
  }
  ~AsideFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  AsideFolder(const AsideFolder&) = delete;
  AsideFolder& operator=(const AsideFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace masked_mapper
