// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/output_folder.hpp"

#include <gtest/gtest.h>

#include "export/output_file.hpp"
#include "export/sample_map.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

Names NamesIn(const fs::path& folder) {
  Names names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// A map as an earlier run left it.
void MakeOldMap(const fs::path& folder) {
  fs::create_directories(folder / "floors");
  WriteFile(folder / "summary.json", "old");
  WriteFile(folder / "building.mmap", "old");
  WriteFile(folder / "floors" / "9.pgm", "old");
}

void WriteNewMap(const fs::path& folder) {
  fs::create_directory(folder / "floors");
  WriteFile(folder / "summary.json", "new");
  WriteFile(folder / "floors" / "0.pgm", "new");
}

TEST(OutputFolder, AppearsWholeOrNotAtAll) {
  const TestFolder folder;
  {
    OutputFolder output(folder / "out", ExistingFolder::kRefuse);
    WriteNewMap(output.path());
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
  EXPECT_TRUE(NamesIn(folder.path()).empty()) << "an abandoned folder stayed";
  {
    OutputFolder output(folder / "out", ExistingFolder::kRefuse);
    WriteNewMap(output.path());
    output.Commit();
  }
  EXPECT_EQ(NamesIn(folder.path()), Names{"out"});
  EXPECT_EQ(FilesBelow(folder / "out"), (Names{"floors/0.pgm", "summary.json"}));
}

TEST(OutputFolder, MakesParentsAndTakesThemBack) {
  const TestFolder folder;
  { OutputFolder output(folder / "a" / "b" / "out", ExistingFolder::kRefuse); }
  EXPECT_TRUE(NamesIn(folder.path()).empty());
  {
    OutputFolder output(folder / "a" / "b" / "out/", ExistingFolder::kRefuse);
    output.Commit();
  }
  EXPECT_TRUE(fs::is_directory(folder / "a" / "b" / "out"));
  EXPECT_EQ(NamesIn(folder / "a" / "b"), Names{"out"});
}

TEST(OutputFolder, ExistingIsRefusedUnasked) {
  const TestFolder folder;
  fs::create_directory(folder / "out");
  WriteFile(folder / "file", "mine");
  fs::create_directory_symlink(folder / "nowhere", folder / "link");
  EXPECT_THROW(OutputFolder(folder / "out", ExistingFolder::kRefuse), InputError);
  for (const auto existing :
       {ExistingFolder::kRefuse, ExistingFolder::kReplace, ExistingFolder::kComplete}) {
    EXPECT_THROW(OutputFolder(folder / "file", existing), InputError);
    EXPECT_THROW(OutputFolder(folder / "file" / "out", existing), InputError);
    EXPECT_THROW(OutputFolder(folder / "link", existing), InputError);
    EXPECT_THROW(OutputFolder("", existing), InputError);
  }
  EXPECT_EQ(NamesIn(folder.path()), (Names{"file", "link", "out"}));
  EXPECT_EQ(ReadBytes(folder / "file"), "mine");
}

TEST(OutputFolder, ReplacesTheMapAndNothingElse) {
  const TestFolder folder;
  MakeOldMap(folder / "out");
  fs::create_directory(folder / "out" / "photos");
  WriteFile(folder / "out" / "photos" / "building.bt", "mine");
  WriteFile(folder / "out" / "notes.txt", "mine");
  WriteFile(folder / "out" / "floors" / "plan.txt", "mine");
  {
    OutputFolder output(folder / "out", ExistingFolder::kReplace);
    WriteNewMap(output.path());
    EXPECT_EQ(ReadBytes(folder / "out" / "summary.json"), "old");
  }
  EXPECT_EQ(ReadBytes(folder / "out" / "summary.json"), "old") << "replaced though abandoned";
  {
    OutputFolder output(folder / "out", ExistingFolder::kReplace);
    WriteNewMap(output.path());
    output.Commit();
  }
  EXPECT_EQ(NamesIn(folder.path()), Names{"out"});
  EXPECT_EQ(FilesBelow(folder / "out"), (Names{"floors/0.pgm", "floors/plan.txt", "notes.txt",
                                               "photos/building.bt", "summary.json"}));
  EXPECT_EQ(ReadBytes(folder / "out" / "summary.json"), "new");
  EXPECT_EQ(ReadBytes(folder / "out" / "photos" / "building.bt"), "mine");
}

TEST(OutputFolder, ReplacesWhatALinkPointsTo) {
  const TestFolder folder;
  MakeOldMap(folder / "real");
  fs::create_directory_symlink(folder / "real", folder / "link");
  OutputFolder output(folder / "link", ExistingFolder::kReplace);
  WriteNewMap(output.path());
  output.Commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(ReadBytes(folder / "real" / "summary.json"), "new");
}

TEST(OutputFolder, NeverReplacesTheWorkingFolder) {
  const TestFolder folder;
  const fs::path before = fs::current_path();
  fs::create_directories(folder / "here" / "inner");
  fs::current_path(folder / "here" / "inner");
  EXPECT_THROW(OutputFolder(".", ExistingFolder::kReplace), InputError);
  EXPECT_THROW(OutputFolder("..", ExistingFolder::kReplace), InputError);
  EXPECT_THROW(OutputFolder("/", ExistingFolder::kReplace), InputError);
  fs::current_path(before);
}

TEST(OutputFolder, CompletesWhatIsThere) {
  const TestFolder folder;
  MakeOldMap(folder / "out");
  OutputFolder output(folder / "out", ExistingFolder::kComplete);
  WriteNewMap(output.path());
  output.Commit();
  EXPECT_EQ(NamesIn(folder.path()), Names{"out"});
  EXPECT_EQ(FilesBelow(folder / "out"), (Names{"building.mmap", "floors/0.pgm", "summary.json"}));
  EXPECT_EQ(ReadBytes(folder / "out" / "building.mmap"), "old");
  EXPECT_EQ(ReadBytes(folder / "out" / "summary.json"), "new");
}

TEST(OutputFolder, CompletesFoldersFileByFile) {
  const TestFolder folder;
  MakeOldMap(folder / "out");
  WriteFile(folder / "out" / "floors" / "plan.txt", "mine");
  OutputFolder output(folder / "out", ExistingFolder::kComplete);
  WriteNewMap(output.path());
  output.Commit();
  EXPECT_EQ(FilesBelow(folder / "out"),
            (Names{"building.mmap", "floors/0.pgm", "floors/plan.txt", "summary.json"}));
}

TEST(OutputFolder, SomeoneElsesNewFolderIsLeftAlone) {
  const TestFolder folder;
  {
    OutputFolder output(folder / "out", ExistingFolder::kRefuse);
    fs::create_directory(folder / "out");
    WriteFile(folder / "out" / "mine.txt", "mine");
    EXPECT_THROW(output.Commit(), std::runtime_error);
  }
  EXPECT_EQ(FilesBelow(folder.path()), Names{"out/mine.txt"});
}

}  // namespace
}  // namespace masked_mapper
