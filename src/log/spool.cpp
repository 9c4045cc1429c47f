// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/live_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
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

Spool::Spool(std::string name) : name_(std::move(name)), file_(OpenNameless()) {
  if (file_ < 0) {
    throw InputError(name_ + ": a stream is kept in a temporary file, which cannot be made: " +
                     std::strerror(errno));
  }
  path_ = "/proc/self/fd/" + std::to_string(file_);
}

Spool::~Spool() { ::close(file_); }

void Spool::Add(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw InputError(
          name_ + ": a stream is kept in a temporary file, which failed: " + std::strerror(errno));
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void Spool::AddAllOf(const std::string& path) {
  const Descriptor stream(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (stream.number() < 0) throw InputError(name_ + ": " + std::strerror(errno));
  std::vector<char> block(std::size_t{1} << 18U);
  while (true) {
    const ssize_t count = ::read(stream.number(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(name_ + ": " + std::strerror(errno));
    if (count == 0) return;
    Add({block.data(), static_cast<std::size_t>(count)});
  }
}

}  // namespace masked_mapper
