// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/output_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>

#include "masked_mapper/text/input_error.hpp"

namespace fs = std::filesystem;

namespace masked_mapper {
namespace {

// Names of the contract; in `floors`, every file with one of these endings is a map's.
constexpr std::array<const char*, 13> kMapFiles = {
    "building.mmap", "building.mmap-wal", "building.mmap-shm", "building.mmap-journal",
    "building.bt",   "building.pcd",      "building.ply",      "trajectory.tum",
    "nodes.tum",     "graph.g2o",         "closures.csv",      "summary.json",
    "report.html"};
// And the folders in it, by name and the endings of a map's files there.
struct InnerFolder {
  const char* name;
  std::array<const char*, 4> endings;
};
constexpr std::array<InnerFolder, 2> kInnerFolders = {{
    {"floors", {".pcd", ".pgm", ".yaml", ".g2o"}},
    {"drives", {".tum", ".tum", ".tum", ".tum"}},
}};

bool IsMapFile(const fs::path& name) {
  return std::find(kMapFiles.begin(), kMapFiles.end(), name) != kMapFiles.end();
}

const InnerFolder* InnerFolderCalled(const fs::path& name) {
  const auto found = std::find_if(kInnerFolders.begin(), kInnerFolders.end(),
                                  [&](const InnerFolder& folder) { return name == folder.name; });
  return found == kInnerFolders.end() ? nullptr : &*found;
}

bool IsFileOf(const InnerFolder& folder, const fs::path& name) {
  return std::find(folder.endings.begin(), folder.endings.end(), name.extension()) !=
         folder.endings.end();
}

// The target without links, dots and a slash at its end.
fs::path Resolved(const fs::path& target) {
  if (target.empty()) throw InputError("the output folder has no name");
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(fs::absolute(target), error);
  if (error) throw InputError(target.string() + ": " + error.message());
  if (!resolved.has_filename()) resolved = resolved.parent_path();
  return resolved;
}

bool Holds(const fs::path& folder, const fs::path& inner) {
  return std::mismatch(folder.begin(), folder.end(), inner.begin(), inner.end()).first ==
         folder.end();
}

[[noreturn]] void Fail(const std::string& what, const fs::path& path,
                       const std::error_code& error) {
  const std::string message = what + " " + path.string() + ": " + error.message();
  // What another choice of folder mends is the user's to mend.
  if (error == std::errc::permission_denied || error == std::errc::not_a_directory ||
      error == std::errc::read_only_file_system || error == std::errc::filename_too_long ||
      error == std::errc::operation_not_permitted) {
    throw InputError(message);
  }
  throw std::runtime_error(message);
}

void Rename(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw std::runtime_error("cannot write " + to.string() + ": " + error.message());
}

// Swaps two folders: at once where the file system can, else by way of a third name.
void Exchange(const fs::path& a, const fs::path& b) {
  if (renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0) return;
  const fs::path old = a.string() + ".old";
  Rename(b, old);
  try {
    Rename(a, b);
  } catch (...) {
    std::error_code ignored;
    fs::rename(old, b, ignored);
    throw;
  }
  Rename(old, a);
}

// Moves what is not of a map from the replaced folder to the new one.
void CarryOver(const fs::path& replaced, const fs::path& current) {
  for (const fs::directory_entry& entry : fs::directory_iterator(replaced)) {
    const fs::path name = entry.path().filename();
    if (IsMapFile(name)) continue;
    const InnerFolder* folder = InnerFolderCalled(name);
    if (folder == nullptr || !entry.is_directory()) {
      Rename(entry.path(), current / name);
      continue;
    }
    for (const fs::directory_entry& inner : fs::directory_iterator(entry.path())) {
      if (IsFileOf(*folder, inner.path().filename())) continue;
      fs::create_directory(current / name);
      Rename(inner.path(), current / name / inner.path().filename());
    }
  }
}

// A file takes the place of one; a folder is filled file by file, so that nothing else in it goes.
void MoveInto(const fs::directory_entry& entry, const fs::path& place) {
  if (!entry.is_directory() || !fs::exists(place)) {
    Rename(entry.path(), place);
    return;
  }
  for (const fs::directory_entry& inner : fs::directory_iterator(entry.path())) {
    MoveInto(inner, place / inner.path().filename());
  }
}

// Takes away what a map of other floors or drives left in the folders that are written anew.
void RemoveStale(const fs::path& written, const fs::path& current) {
  for (const InnerFolder& folder : kInnerFolders) {
    if (!fs::exists(written / folder.name) || !fs::is_directory(current / folder.name)) continue;
    std::vector<fs::path> stale;
    for (const fs::directory_entry& entry : fs::directory_iterator(current / folder.name)) {
      if (IsFileOf(folder, entry.path().filename())) stale.push_back(entry.path());
    }
    for (const fs::path& file : stale) fs::remove(file);
  }
}

std::vector<fs::path> MakeParents(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  // What cannot be looked at is taken as there; making a folder in it then says why it cannot be.
  for (fs::path parent = folder.parent_path(); !fs::exists(parent, error) && !error;
       parent = parent.parent_path()) {
    missing.insert(missing.begin(), parent);
  }
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (fs::create_directory(missing[i], error) || !error) continue;
    for (std::size_t made = i; made-- > 0;) {
      std::error_code ignored;
      fs::remove(missing[made], ignored);
    }
    Fail("cannot make folder", missing[i], error);
  }
  return missing;
}

}  // namespace

void CheckOutputFolder(const fs::path& target, ExistingFolder existing) {
  const fs::path resolved = Resolved(target);
  const fs::file_status status = fs::symlink_status(resolved);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    throw InputError(target.string() + " exists and is not a folder");
  }
  if (existing == ExistingFolder::kRefuse) {
    throw InputError(target.string() + " exists already; --force replaces it");
  }
  if (existing == ExistingFolder::kReplace && Holds(resolved, fs::current_path())) {
    throw InputError(target.string() + " holds the working folder and cannot be replaced");
  }
}

OutputFolder::OutputFolder(const fs::path& target, ExistingFolder existing)
    : target_(Resolved(target)), existing_(existing) {
  CheckOutputFolder(target, existing);
  made_parents_ = MakeParents(target_);
  std::error_code error;
  for (int attempt = 0;; ++attempt) {
    aside_ = target_.parent_path() / ("." + target_.filename().string() + ".partial-" +
                                      std::to_string(getpid()) + "-" + std::to_string(attempt));
    if (fs::create_directory(aside_, error)) return;
    if (error) break;
  }
  for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) {
    std::error_code ignored;
    fs::remove(*parent, ignored);
  }
  Fail("cannot make folder", aside_, error);
}

OutputFolder::~OutputFolder() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
  for (auto parent = made_parents_.rbegin(); parent != made_parents_.rend(); ++parent) {
    fs::remove(*parent, ignored);
  }
}

void OutputFolder::Commit() {
  if (!fs::exists(fs::symlink_status(target_))) {
    Rename(aside_, target_);
  } else if (existing_ == ExistingFolder::kReplace) {
    Replace();
  } else if (existing_ == ExistingFolder::kComplete) {
    Complete();
  } else {
    throw std::runtime_error(target_.string() + " was made by someone else meanwhile");
  }
  committed_ = true;
}

void OutputFolder::Replace() {
  Exchange(aside_, target_);
  // The new map is in place; from here on nothing may remove it, and `aside_` is the old one.
  committed_ = true;
  CarryOver(aside_, target_);
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
}

void OutputFolder::Complete() {
  RemoveStale(aside_, target_);
  for (const fs::directory_entry& entry : fs::directory_iterator(aside_)) {
    MoveInto(entry, target_ / entry.path().filename());
  }
  std::error_code ignored;
  fs::remove_all(aside_, ignored);
}

}  // namespace masked_mapper
