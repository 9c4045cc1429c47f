// SPDX-License-Identifier: BSD-3-Clause
// A file of a test's own, by a name that its reader looks at.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace masked_mapper {

/// Writes `text` to `name` in the tests' folder; returns the path.
inline std::string Write(const std::string& name, const std::string& text) {
  const std::string path = (std::filesystem::path(testing::TempDir()) / name).string();
  std::ofstream(path) << text;
  return path;
}

}  // namespace masked_mapper
