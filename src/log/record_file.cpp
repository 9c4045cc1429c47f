// SPDX-License-Identifier: BSD-3-Clause
#include "record_file.hpp"

#include <algorithm>
#include <utility>

namespace masked_mapper {
namespace {

constexpr std::uint64_t kLargestHeader = std::uint64_t{1} << 20U;

}  // namespace

RecordFile::RecordFile(const std::string& path, std::string shown_name)
    : file_(path, std::move(shown_name)) {}

bool RecordFile::ReadHeader(RecordHeader* header, std::uint64_t* data_size) {
  std::uint64_t header_size = 0;
  if (!ReadLength(&header_size)) return false;
  if (header_size > std::min(kLargestHeader, left())) return false;
  Read(header_size, &header_bytes_);
  return header->Parse(header_bytes_.data(), header_bytes_.size()) && ReadLength(data_size);
}

bool RecordFile::ReadLength(std::uint64_t* length) {
  unsigned char bytes[4];
  if (left() < sizeof(bytes)) return false;
  file_.Read(bytes, sizeof(bytes));
  position_ += sizeof(bytes);
  *length = LittleEndian(bytes, sizeof(bytes));
  return true;
}

void RecordFile::Read(std::uint64_t count, std::vector<unsigned char>* bytes) {
  bytes->resize(count);
  file_.Read(bytes->data(), count);
  position_ += count;
}

bool RecordFile::Skip(std::uint64_t count) {
  const bool fits = count <= left();
  Seek(fits ? position_ + count : file_.size());
  return fits;
}

void RecordFile::Seek(std::uint64_t position) {
  file_.Seek(position);
  position_ = position;
}

}  // namespace masked_mapper
