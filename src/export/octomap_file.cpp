// SPDX-License-Identifier: BSD-3-Clause
#include "octomap_file.hpp"

#include <string>

#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
void WriteOctomap(const OctreeData& tree, const std::filesystem::path& path) {
  OutputFile file(path);
  file.Write("# Octomap OcTree binary file\nid OcTree\nsize " + std::to_string(tree.nodes) +
             "\nres " + ExactText(tree.resolution_m) + "\ndata\n");
  file.Write(tree.bytes);
  file.Close();
}

}  // namespace masked_mapper
