// SPDX-License-Identifier: BSD-3-Clause
// A bug of ours stops the program, and says what did not hold. For what would otherwise be found
// out only in a wrong map, so in release builds, too; never for what a file or a user says.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace masked_mapper {

/// `what` is the sentence that is true of a right program.
inline void Check(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "masked_mapper: bug: not so: %s\n", what);
  std::abort();
}

}  // namespace masked_mapper
