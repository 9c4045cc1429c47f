// SPDX-License-Identifier: BSD-3-Clause
#include "file_window.hpp"

#include <algorithm>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kWindow = std::size_t{16} << 10U;

}  // namespace

FileWindow::FileWindow(const std::string& path, std::string shown_name)
    : name_(std::move(shown_name)), file_(path, name_) {
  // The window is the buffer.
  std::setvbuf(file_.stream.get(), nullptr, _IONBF, 0);
}

void FileWindow::Fill(std::uint64_t offset, unsigned char* to, std::size_t count) {
  if (::fseeko(file_.stream.get(), static_cast<off_t>(offset), SEEK_SET) != 0 ||
      std::fread(to, 1, count, file_.stream.get()) != count) {
    throw InputError(name_ + ": cannot be read");
  }
}

const unsigned char* FileWindow::At(std::uint64_t offset, std::size_t count, std::size_t* found) {
  *found = static_cast<std::size_t>(
      std::min<std::uint64_t>(count, file_.size - std::min(file_.size, offset)));
  if (offset < window_begin_ || offset + *found > window_begin_ + window_.size()) {
    window_.resize(std::min<std::uint64_t>(std::max(kWindow, *found), file_.size - offset));
    window_begin_ = offset;
    Fill(offset, window_.data(), window_.size());
  }
  return window_.data() + (offset - window_begin_);
}

void FileWindow::Read(std::uint64_t offset, std::size_t count, Bytes* bytes) {
  bytes->resize(count);
  Fill(offset, bytes->data(), count);
}

}  // namespace masked_mapper
