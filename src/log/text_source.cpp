// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/text_source.hpp"

#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "masked_mapper/text/ends_with.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kFileBlock = 128 * 1024;

/// Size of a regular file; throws InputError for anything else.
std::uint64_t RegularFileSize(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw InputError(path + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)));
  }
  if (S_ISDIR(status.st_mode)) throw InputError(path + ": is a directory, expected a log file");
  if (!S_ISREG(status.st_mode)) throw InputError(path + ": is not a regular file");
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

class TextSource::Impl {
 public:
  explicit Impl(const std::string& path)
      : path_(path), file_size_(RegularFileSize(path)), input_(kFileBlock) {
    file_ = std::fopen(path.c_str(), "rb");
    if (file_ == nullptr) throw InputError(path + ": " + std::strerror(errno));
    try {
      Refill();
      is_gzip_ = AtGzipMagic();
      if (!is_gzip_ && file_size_ > 0 && EndsWith(path, ".gz")) {
        throw InputError(path + ": named .gz, but not gzip");
      }
      if (is_gzip_) {
        // 16 + 15: a gzip header is demanded, and the largest window allowed.
        if (inflateInit2(&stream_, 16 + MAX_WBITS) != Z_OK) throw std::bad_alloc();
        inflating_ = true;
      }
    } catch (...) {
      std::fclose(file_);
      throw;
    }
  }

  ~Impl() {
    if (inflating_) inflateEnd(&stream_);
    std::fclose(file_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::size_t Read(char* buffer, std::size_t capacity) {
    return is_gzip_ ? ReadGzip(buffer, capacity) : ReadPlain(buffer, capacity);
  }

  bool is_gzip() const { return is_gzip_; }
  bool truncated() const { return truncated_; }
  std::uint64_t trailing_bytes() const { return trailing_bytes_; }
  double Progress() const {
    if (file_size_ == 0) return 1.0;
    const std::uint64_t consumed = bytes_read_ - (input_end_ - input_begin_);
    return std::min(1.0, static_cast<double>(consumed) / static_cast<double>(file_size_));
  }

 private:
  /// Tops the input block up; false when the file has no more to give.
  bool Refill() {
    std::memmove(input_.data(), input_.data() + input_begin_, input_end_ - input_begin_);
    input_end_ -= input_begin_;
    input_begin_ = 0;
    const std::size_t count =
        std::fread(input_.data() + input_end_, 1, input_.size() - input_end_, file_);
    if (count == 0 && std::ferror(file_) != 0) throw InputError(path_ + ": cannot be read");
    input_end_ += count;
    bytes_read_ += count;
    return count > 0;
  }

  bool AtGzipMagic() const {
    return input_end_ - input_begin_ >= 2 && input_[input_begin_] == 0x1f &&
           input_[input_begin_ + 1] == 0x8b;
  }

  std::size_t ReadPlain(char* buffer, std::size_t capacity) {
    std::size_t filled = 0;
    while (filled < capacity) {
      if (input_begin_ == input_end_ && !Refill()) break;
      const std::size_t count = std::min(capacity - filled, input_end_ - input_begin_);
      std::memcpy(buffer + filled, input_.data() + input_begin_, count);
      input_begin_ += count;
      filled += count;
    }
    return filled;
  }

  std::size_t ReadGzip(char* buffer, std::size_t capacity) {
    std::size_t filled = 0;
    while (filled < capacity && inflating_) {
      if (input_begin_ == input_end_ && !Refill()) {
        truncated_ = true;
        StopInflating();
        break;
      }
      stream_.next_in = input_.data() + input_begin_;
      stream_.avail_in = static_cast<uInt>(input_end_ - input_begin_);
      stream_.next_out = reinterpret_cast<Bytef*>(buffer + filled);
      stream_.avail_out =
          static_cast<uInt>(std::min<std::size_t>(capacity - filled, std::size_t{1} << 30));
      const uInt room = stream_.avail_out;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      input_begin_ = input_end_ - stream_.avail_in;
      filled += room - stream_.avail_out;
      if (status == Z_STREAM_END) {
        BeginNextMember();
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        truncated_ = true;
        StopInflating();
      }
    }
    return filled;
  }

  /// Gzip files may be concatenated; anything else behind a member is ignored, as gzip itself does.
  void BeginNextMember() {
    if (input_end_ - input_begin_ < 2) Refill();
    if (AtGzipMagic()) {
      inflateReset(&stream_);
      return;
    }
    trailing_bytes_ = file_size_ - std::min(file_size_, bytes_read_ - (input_end_ - input_begin_));
    StopInflating();
  }

  void StopInflating() {
    inflateEnd(&stream_);
    inflating_ = false;
    input_begin_ = input_end_;
  }

  std::string path_;
  std::uint64_t file_size_ = 0;
  std::FILE* file_ = nullptr;
  std::vector<unsigned char> input_;
  std::size_t input_begin_ = 0;
  std::size_t input_end_ = 0;
  std::uint64_t bytes_read_ = 0;
  z_stream stream_{};
  bool is_gzip_ = false;
  bool inflating_ = false;
  bool truncated_ = false;
  std::uint64_t trailing_bytes_ = 0;
};

TextSource::TextSource(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
TextSource::~TextSource() = default;

std::size_t TextSource::Read(char* buffer, std::size_t capacity) {
  return impl_->Read(buffer, capacity);
}
bool TextSource::IsGzip() const { return impl_->is_gzip(); }
bool TextSource::Truncated() const { return impl_->truncated(); }
std::uint64_t TextSource::TrailingBytes() const { return impl_->trailing_bytes(); }
double TextSource::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
