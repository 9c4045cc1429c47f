// SPDX-License-Identifier: BSD-3-Clause
#include "output_file.hpp"

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace masked_mapper {

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) Fail();
}

void OutputFile::Write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) Fail();
}

void OutputFile::Close() {
  if (std::fclose(file_.release()) != 0) Fail();
}

void OutputFile::Fail() const {
  throw std::runtime_error("cannot write " + path_.string() + ": " +
                           std::generic_category().message(errno));
}

void WriteFile(const std::filesystem::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.Write(bytes);
  file.Close();
}

}  // namespace masked_mapper
