// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/floor_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "carmen_line.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kLongestLine = 200;

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Empty when the line is not `t,label`.
std::optional<FloorLabel> ParseLine(const std::string& line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const std::string stamp = Trimmed(line.substr(0, comma));
  const char* cursor = stamp.c_str();
  const char* const end = cursor + stamp.size();
  const std::optional<double> value = ParseNumber(cursor, end);
  if (!value || cursor != end || !std::isfinite(*value)) return std::nullopt;
  return FloorLabel{*value, Trimmed(line.substr(comma + 1))};
}

}  // namespace

bool IsFloorLabel(const std::string& label) {
  constexpr std::size_t kLongest = 64;
  return !label.empty() && label.size() <= kLongest && label != "." && label != ".." &&
         std::all_of(label.begin(), label.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '.' || c == '-';
         });
}

std::vector<FloorLabel> ReadFloorFile(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(path + ": is a directory, not a file of floors");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<FloorLabel> labels;
  bool names_a_floor = false;
  std::array<char, kLongestLine + 2> buffer;
  for (std::size_t number = 1;
       file.getline(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
       file.gcount() > 0;
       ++number) {
    const auto fail = [&](const std::string& reason) {
      throw InputError(path + ":" + std::to_string(number) + ": " + reason);
    };
    if (file.fail()) fail("the line is longer than " + std::to_string(kLongestLine));
    // What was read counts the line's end, where there is one; a zero byte does not end the line.
    const auto letters = static_cast<std::size_t>(file.gcount() - (file.eof() ? 0 : 1));
    const std::string line = Trimmed({buffer.data(), letters});
    if (line.empty() || line.front() == '#' || (labels.empty() && line == "t,label")) continue;
    const std::optional<FloorLabel> label = ParseLine(line);
    if (!label) fail("expected `t,label`: a stamp in seconds and a floor, or `-` in transit");
    if (!IsFloorLabel(label->label)) {
      fail("a label is up to 64 of A-Z a-z 0-9 _ . - and is not . or ..");
    }
    if (!labels.empty() && label->stamp < labels.back().stamp) fail("the stamp steps back");
    names_a_floor |= label->label != "-";
    labels.push_back(*label);
  }
  if (!names_a_floor) throw InputError(path + ": no line says a floor");
  return labels;
}

}  // namespace masked_mapper
