// SPDX-License-Identifier: BSD-3-Clause
// A grey picture as PNG, for tools that open no PGM.
#pragma once

#include <filesystem>
#include <string>

namespace masked_mapper {

/// `pixels` row by row from the top, one byte each. Throws std::runtime_error when the file cannot
/// be written.
void WriteGreyPng(const std::string& pixels, int width, const std::filesystem::path& path);

}  // namespace masked_mapper
