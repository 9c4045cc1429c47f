// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/number_text.hpp"

#include <array>
#include <cassert>
#include <charconv>
#include <system_error>

namespace masked_mapper {
namespace {

using Digits = std::array<char, 400>;  // 1e308 in full, its decimals included

std::string WithoutSignOfZero(const char* begin, const char* end) {
  std::string text(begin, end);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

}  // namespace

std::string FixedText(double value, int decimals) {
  assert(decimals >= 0 && decimals < 50);
  Digits digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, decimals);
  assert(end.ec == std::errc());
  return WithoutSignOfZero(digits.data(), end.ptr);
}

std::string ShortText(double value, int digits) {
  assert(digits > 0 && digits < 50);
  Digits text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, digits);
  assert(end.ec == std::errc());
  return {text.data(), end.ptr};
}

std::string ExactText(double value) {
  Digits digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  assert(end.ec == std::errc());
  return WithoutSignOfZero(digits.data(), end.ptr);
}

}  // namespace masked_mapper
