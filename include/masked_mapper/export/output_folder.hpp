// SPDX-License-Identifier: BSD-3-Clause
// The folder of a map, all or nothing: files are written into a folder beside the target, which
// takes the target's place when all are there. Whatever ends the work before that leaves the target
// as it was.
#pragma once

#include <filesystem>
#include <vector>

namespace masked_mapper {

enum class ExistingFolder {
  kRefuse,    ///< an existing target is the user's mistake
  kReplace,   ///< a map in it is replaced; files that are not of a map are kept
  kComplete,  ///< files are added to it, replacing those of the same name and nothing else
};

/// Throws InputError when a map could not go to `target`: it exists though it must not, is no
/// folder, or holds the working folder. To be asked before the work starts; makes nothing.
void CheckOutputFolder(const std::filesystem::path& target, ExistingFolder existing);

class OutputFolder {
 public:
  /// Checks as above and makes the folder to write into. Throws InputError, or std::runtime_error
  /// when the machine is at fault.
  OutputFolder(const std::filesystem::path& target, ExistingFolder existing);
  /// Removes what was not committed.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& path() const { return aside_; }
  /// Puts what was written in its place. Throws std::runtime_error.
  void Commit();

 private:
  void Replace();
  void Complete();

  std::filesystem::path target_;
  std::filesystem::path aside_;
  ExistingFolder existing_;
  std::vector<std::filesystem::path> made_parents_;  // outermost first
  bool committed_ = false;
};

}  // namespace masked_mapper
