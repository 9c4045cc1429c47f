// SPDX-License-Identifier: BSD-3-Clause
#include "png_file.hpp"

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "output_file.hpp"

namespace masked_mapper {
namespace {

std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

std::string Chunk(const std::string& kind, const std::string& content) {
  const std::string body = kind + content;
  const auto checksum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
  return BigEndian(static_cast<std::uint32_t>(content.size())) + body + BigEndian(checksum);
}

std::string Packed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                6) != Z_OK) {
    throw std::runtime_error("cannot pack a picture");
  }
  packed.resize(size);
  return packed;
}

}  // namespace

void WriteGreyPng(const std::string& pixels, int width, const std::filesystem::path& path) {
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows = columns == 0 ? 0 : pixels.size() / columns;
  std::string lines;
  lines.reserve(pixels.size() + rows);
  for (std::size_t row = 0; row < rows; ++row) {
    lines += '\0';  // as it is: no filter
    lines.append(pixels, row * columns, columns);
  }
  const std::string header = BigEndian(static_cast<std::uint32_t>(width)) +
                             BigEndian(static_cast<std::uint32_t>(rows)) +
                             std::string("\x08\0\0\0\0", 5);  // 8 bits of grey
  WriteFile(path, "\x89PNG\r\n\x1a\n" + Chunk("IHDR", header) + Chunk("IDAT", Packed(lines)) +
                      Chunk("IEND", ""));
}

}  // namespace masked_mapper
