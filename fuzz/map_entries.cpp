// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "fuzz/entries.hpp"
#include "fuzz/input_file.hpp"
#include "masked_mapper/editing/edits.hpp"
#include "masked_mapper/map_file/saved_map.hpp"
#include "masked_mapper/options/option_table.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper::fuzz {

void Configuration(const std::uint8_t* data, std::size_t size) {
  Options options;
  try {
    ReadConfigurationText("fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size),
                          options);
  } catch (const InputError&) {
  }
}

void Edits(const std::uint8_t* data, std::size_t size) {
  static const SavedMap start =
      ReadMapFile(MASKED_MAPPER_SOURCE_DIR "/fuzz/corpus/map_file/drive.mmap");
  BuildingMap map = start.result;
  try {
    ApplyEditsText("fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size),
                   start.origin.options.mapping.closures, map);
  } catch (const InputError&) {
  }
}

void MapFile(const std::uint8_t* data, std::size_t size) {
  const InputFile file(".mmap", data, size);
  try {
    ReadMapFile(file.path());
  } catch (const InputError&) {
  }
}

}  // namespace masked_mapper::fuzz
