// SPDX-License-Identifier: BSD-3-Clause
#include "output_bytes.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "checksum.hpp"

namespace masked_mapper {
OutputBytes::OutputBytes(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) throw std::runtime_error(path + ": cannot be created: " + std::strerror(errno));
}

void OutputBytes::Write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) Fail();
  position_ += bytes.size();
  checksum_ = Crc32After(checksum_, bytes.data(), bytes.size());
}

void OutputBytes::WriteAt(std::uint64_t position, std::string_view bytes) {
  const auto seek = [this](std::uint64_t to) {
    if (::fseeko(file_.get(), static_cast<off_t>(to), SEEK_SET) != 0) Fail();
  };
  seek(position);
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) Fail();
  seek(position_);
}

void OutputBytes::Close() {
  if (file_ && std::fclose(file_.release()) != 0) Fail();
}

void OutputBytes::Fail() const {
  throw std::runtime_error(path_ + ": cannot be written" +
                           (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

void AppendString(std::string_view text, std::string* bytes) {
  AppendNumber(static_cast<std::uint32_t>(text.size()), bytes);
  bytes->append(text);
}

}  // namespace masked_mapper
