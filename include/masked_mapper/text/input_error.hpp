// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace masked_mapper {

/// The user's input is at fault. The message is one clear line: which file, line or key, and what
/// was expected. The program prints it and exits with code 2; the library neither prints nor exits.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace masked_mapper
