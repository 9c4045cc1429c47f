// SPDX-License-Identifier: BSD-3-Clause
// The two compressions of a ROS 1 bag's chunks. Both give the good part of a damaged stream, and
// whether it was whole. Memory grows with what the stream really holds, not with what its header
// promises.
#pragma once

#include <cstddef>
#include <vector>

namespace masked_mapper {

bool DecompressBz2(const std::vector<unsigned char>& packed, std::size_t limit,
                   std::vector<unsigned char>* out);
bool DecompressLz4(const std::vector<unsigned char>& packed, std::size_t limit,
                   std::vector<unsigned char>* out);

}  // namespace masked_mapper
