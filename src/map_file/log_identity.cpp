// SPDX-License-Identifier: BSD-3-Clause
#include "log_identity.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "masked_mapper/text/input_error.hpp"
#include "packed_bytes.hpp"

namespace fs = std::filesystem;

namespace masked_mapper {
namespace {

// A file that has grown, was cut or replaced; read at both ends alone, since logs are large.
std::string IdentityOf(const std::string& path) {
  constexpr std::streamoff kEnd = 1 << 16;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return "";
  std::ifstream in(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(kEnd), '\0');
  std::uint32_t checksum = 0;
  in.read(bytes.data(), kEnd);
  checksum = Checksum({bytes.data(), static_cast<std::size_t>(in.gcount())}, checksum);
  if (size > static_cast<std::uintmax_t>(kEnd)) {
    in.seekg(-kEnd, std::ios::end);
    in.read(bytes.data(), kEnd);
    checksum = Checksum({bytes.data(), static_cast<std::size_t>(in.gcount())}, checksum);
  }
  return std::to_string(size) + " bytes, checksum " + std::to_string(checksum);
}

std::string LogIdentity(const std::string& log, const std::string& floors_file) {
  const std::string floors = IdentityOf(floors_file);
  return IdentityOf(log) + (floors.empty() ? "" : "; floors: " + floors);
}

// Of everything that is read, a line each, by name.
std::vector<std::pair<std::string, std::string>> Identities(const MapOrigin& origin) {
  std::vector<std::pair<std::string, std::string>> lines = {
      {origin.log, LogIdentity(origin.log, origin.options.mapping.floors.file)}};
  for (const MapOrigin::LaterLog& later : origin.later_logs) {
    lines.emplace_back(later.log, LogIdentity(later.log, later.floors));
  }
  if (!origin.onto.empty()) {
    std::error_code missing;
    fs::path file = origin.onto;
    if (fs::is_directory(file, missing)) file /= kMapFileName;
    lines.emplace_back(origin.onto, IdentityOf(file.string()));
  }
  return lines;
}

}  // namespace

std::string IdentityText(const MapOrigin& origin) {
  std::string text;
  for (const auto& [name, line] : Identities(origin)) text += (text.empty() ? "" : "\n") + line;
  return text;
}

void CheckUnchanged(const MapOrigin& origin, const std::string& identity_before) {
  if (IdentityText(origin) == identity_before) return;
  std::istringstream before(identity_before);
  for (const auto& [name, line] : Identities(origin)) {
    std::string line_before;
    std::getline(before, line_before);
    if (line != line_before) {
      throw InputError(name +
                       ": has changed since the unfinished map was begun; --force starts afresh");
    }
  }
  throw InputError("the unfinished map is of other logs; --force starts afresh");
}

}  // namespace masked_mapper
