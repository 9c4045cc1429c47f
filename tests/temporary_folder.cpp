// SPDX-License-Identifier: BSD-3-Clause
// Every test program has a temporary folder of its own, which goes away with it: tests run side by
// side, each in a process of its own, and two that choose the same name of a file must not meet.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace masked_mapper {
namespace {

class TemporaryFolder : public testing::Environment {
 public:
  void SetUp() override {
    folder_ = (std::filesystem::temp_directory_path() / "masked_mapper_test_XXXXXX").string();
    if (::mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("cannot make " + folder_);
    // GoogleTest's is a prefix of names; the other is standard C++'s, and that of programs run.
    ::setenv("TEST_TMPDIR", (folder_ + "/").c_str(), 1);
    ::setenv("TMPDIR", folder_.c_str(), 1);
  }

  void TearDown() override { std::filesystem::remove_all(folder_); }

 private:
  std::string folder_;
};

const auto* const kFolder = testing::AddGlobalTestEnvironment(new TemporaryFolder);

}  // namespace
}  // namespace masked_mapper
