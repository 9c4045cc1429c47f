// SPDX-License-Identifier: BSD-3-Clause
// A file of the fuzzer's bytes, in memory where the system has such a folder.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace masked_mapper::fuzz {

class InputFile {
 public:
  InputFile(const std::string& ending, const std::uint8_t* data, std::size_t size) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::exists("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
    path_ = (folder / ("masked_mapper_fuzz_" + std::to_string(::getpid()) + ending)).string();
    std::ofstream out(path_, std::ios::binary);
    out.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    out.close();
    if (!out) std::abort();
  }
  ~InputFile() { std::remove(path_.c_str()); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace masked_mapper::fuzz
