// SPDX-License-Identifier: BSD-3-Clause
#include "bag_record.hpp"

#include <cstring>

namespace masked_mapper {

std::uint64_t LittleEndian(const unsigned char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = (value << 8U) | bytes[i];
  return value;
}

bool RecordHeader::Parse(const unsigned char* data, std::size_t size) {
  data_ = data;
  size_ = size;
  std::size_t at = 0;
  while (at < size) {
    if (size - at < 4) return false;
    const std::size_t length = LittleEndian(data + at, 4);
    at += 4;
    if (length > size - at || std::memchr(data + at, '=', length) == nullptr) return false;
    at += length;
  }
  return true;
}

std::string_view RecordHeader::Find(std::string_view name) const {
  std::size_t at = 0;
  while (at < size_) {
    const std::size_t length = LittleEndian(data_ + at, 4);
    const std::string_view field(reinterpret_cast<const char*>(data_ + at + 4), length);
    const std::size_t equals = field.find('=');
    if (field.substr(0, equals) == name) return field.substr(equals + 1);
    at += 4 + length;
  }
  return {};
}

std::optional<std::uint64_t> RecordHeader::Number(std::string_view name, std::size_t size) const {
  const std::string_view value = Find(name);
  if (value.size() != size) return std::nullopt;
  return LittleEndian(reinterpret_cast<const unsigned char*>(value.data()), size);
}

}  // namespace masked_mapper
