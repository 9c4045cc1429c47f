// SPDX-License-Identifier: BSD-3-Clause
#include "spooled_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "masked_mapper/text/input_error.hpp"
#include "text_source.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

// Recordings shrink to a fifth, one that stands still to a fiftieth.
constexpr double kGreatestGrowth = 1000.0;
constexpr double kSmall = 64e6;  // bytes that may come of anything

}  // namespace

SpooledFile::SpooledFile(const std::string& path) {
  TextSource source(path);
  std::error_code no_folder;
  const fs::path folder = fs::temp_directory_path(no_folder);
  path_ = (folder / "masked_mapper_unpacked_XXXXXX").string();
  const int descriptor = ::mkstemp(path_.data());
  if (descriptor < 0) {
    throw InputError(path + ": cannot be unpacked: no temporary file in `" + folder.string() +
                     "`: " + std::strerror(errno));
  }
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, CloseFile> file(::fdopen(descriptor, "wb"));
  try {
    const auto fail = [&] {
      throw InputError(path + ": cannot be unpacked to " + path_ + ": " + std::strerror(errno));
    };
    if (!file) fail();
    const double most =
        std::max(kSmall, kGreatestGrowth * static_cast<double>(fs::file_size(path)));
    double written = 0.0;
    std::vector<char> block(std::size_t{1} << 20U);
    while (const std::size_t count = source.Read(block.data(), block.size())) {
      written += static_cast<double>(count);
      if (written > most) {
        throw InputError(path + ": unpacks to more than 1000 times its size, as no recording does");
      }
      if (std::fwrite(block.data(), 1, count, file.get()) != count) fail();
    }
    if (std::fclose(file.release()) != 0) fail();
  } catch (...) {
    ::unlink(path_.c_str());
    throw;
  }
  truncated_ = source.Truncated();
}

SpooledFile::~SpooledFile() { ::unlink(path_.c_str()); }

}  // namespace masked_mapper
