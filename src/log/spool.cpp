// SPDX-License-Identifier: BSD-3-Clause
#include "spool.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// A descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

bool WriteAll(int file, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(file, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

/// A file without a name in the folder for temporary files.
int OpenNameless() {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) folder = "/tmp";
  std::string name = (folder / "masked_mapper-XXXXXX").string();
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

}  // namespace

bool Spool::IsStream(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return false;
  return S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode) || S_ISCHR(status.st_mode);
}

Spool::Spool(const std::string& path) {
  const auto fail = [&path](const std::string& what) {
    throw InputError(path + ": " + what + std::strerror(errno));
  };
  const Descriptor stream(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (stream.number() < 0) fail("");
  file_ = OpenNameless();
  if (file_ < 0) fail("a stream is kept in a temporary file, which cannot be made: ");
  std::vector<char> block(std::size_t{1} << 18U);
  while (true) {
    const ssize_t count = ::read(stream.number(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) break;
    if (count < 0 || !WriteAll(file_, block.data(), static_cast<std::size_t>(count))) {
      ::close(file_);
      fail("a stream is kept in a temporary file, which failed: ");
    }
  }
  path_ = "/proc/self/fd/" + std::to_string(file_);
}

Spool::~Spool() { ::close(file_); }

}  // namespace masked_mapper
