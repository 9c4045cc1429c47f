// SPDX-License-Identifier: BSD-3-Clause
#include "regular_file.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {

RegularFile::RegularFile(const std::string& path, std::string shown_name)
    : name_(std::move(shown_name)) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw InputError(name_ + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)));
  }
  if (S_ISDIR(status.st_mode)) throw InputError(name_ + ": is a directory, expected a log file");
  if (!S_ISREG(status.st_mode)) throw InputError(name_ + ": is not a regular file");
  size_ = static_cast<std::uint64_t>(status.st_size);
  stream_.reset(std::fopen(path.c_str(), "rb"));
  if (!stream_) throw InputError(name_ + ": " + std::strerror(errno));
}

void RegularFile::Fail() const { throw InputError(name_ + ": cannot be read"); }

void RegularFile::Seek(std::uint64_t position) {
  if (::fseeko(stream_.get(), static_cast<off_t>(position), SEEK_SET) != 0) Fail();
}

void RegularFile::Read(unsigned char* to, std::size_t count) {
  if (ReadSome(to, count) != count) Fail();
}

std::size_t RegularFile::ReadSome(unsigned char* to, std::size_t count) {
  const std::size_t found = std::fread(to, 1, count, stream_.get());
  if (found < count && std::ferror(stream_.get()) != 0) Fail();
  return found;
}

}  // namespace masked_mapper
