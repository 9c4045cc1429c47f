// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text, the same under every locale.
#pragma once

#include <string>

namespace masked_mapper {

/// With so many decimals; zero has no sign.
std::string FixedText(double value, int decimals);

/// With so many digits that say something, as people write it: 0.05, 12, 1e-07.
std::string ShortText(double value, int digits = 6);

/// The shortest decimals that read back as the same number, without an exponent.
std::string ExactText(double value);

}  // namespace masked_mapper
