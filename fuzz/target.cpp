// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's door to the entry that CMake names.
#include "fuzz/entries.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  masked_mapper::fuzz::MASKED_MAPPER_FUZZ_ENTRY(data, size);
  return 0;
}
