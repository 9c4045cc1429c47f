// SPDX-License-Identifier: BSD-3-Clause
#include "file_window.hpp"

#include <algorithm>

namespace masked_mapper {
namespace {

constexpr std::size_t kWindow = std::size_t{16} << 10U;

}  // namespace

FileWindow::FileWindow(const std::string& path, std::string shown_name)
    : file_(path, std::move(shown_name)) {
  file_.LeaveUnbuffered();  // the window is the buffer
}

void FileWindow::Fill(std::uint64_t offset, unsigned char* to, std::size_t count) {
  file_.Seek(offset);
  file_.Read(to, count);
}

const unsigned char* FileWindow::At(std::uint64_t offset, std::size_t count, std::size_t* found) {
  *found = static_cast<std::size_t>(
      std::min<std::uint64_t>(count, file_.size() - std::min(file_.size(), offset)));
  if (offset < window_begin_ || offset + *found > window_begin_ + window_.size()) {
    window_.resize(std::min<std::uint64_t>(std::max(kWindow, *found), file_.size() - offset));
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
