// SPDX-License-Identifier: BSD-3-Clause
// What is fuzzed: each entry takes the bytes of a file as if they came from an enemy. A refusal
// with an InputError is right, and so is reading what can be read; all else is a finding. Used by
// the libFuzzer targets (fuzz/run.sh) and, with the kept corpus, by tests/fuzz.
#pragma once

#include <cstddef>
#include <cstdint>

namespace masked_mapper::fuzz {

void CarmenLog(const std::uint8_t* data, std::size_t size);
void RosBag1(const std::uint8_t* data, std::size_t size);
void RosBag2(const std::uint8_t* data, std::size_t size);
void Mcap(const std::uint8_t* data, std::size_t size);
void RosMessages(const std::uint8_t* data, std::size_t size);
/// Of a saved map.
void PackedCloud(const std::uint8_t* data, std::size_t size);
void Configuration(const std::uint8_t* data, std::size_t size);
/// Of the corpus' one map.
void Edits(const std::uint8_t* data, std::size_t size);
void MapFile(const std::uint8_t* data, std::size_t size);

}  // namespace masked_mapper::fuzz
