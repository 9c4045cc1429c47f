// SPDX-License-Identifier: BSD-3-Clause
// The dispatcher: help, mistyped names, exit codes.
#include <gtest/gtest.h>

#include <cstdlib>

#include "apps/program.hpp"

namespace masked_mapper {
namespace {

TEST(CommandLine, HelpTeaches) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"simulate", "--help"}, {"info", "--help"}}) {
    const Ran ran = RunProgram(arguments);
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(ran.err, "");
    EXPECT_TRUE(Contains(ran.out, "masked_mapper info") || Contains(ran.out, "Examples:"))
        << ran.out;
  }
}

TEST(CommandLine, MistypedCommandsAndFlags) {
  const ScratchFolder folder;
  ExpectUsersFault(folder, {}, "a command is needed");
  ExpectUsersFault(folder, {"inof"}, "unknown command `inof` (did you mean `info`?)");
  ExpectUsersFault(folder, {"xyz"}, "unknown command `xyz`");
  ExpectUsersFault(folder, {"--nonsense"}, "unknown flag `--nonsense`");
  ExpectUsersFault(folder, {"--hepl"}, "unknown flag `--hepl` (did you mean `--help`?)");
  ExpectUsersFault(folder, {"info"}, "LOG is required");
  ExpectUsersFault(folder, {"info", "a.log", "--jsno"}, "did you mean `--json`?");
  ExpectUsersFault(folder, {"info", "a.log", "b.log"}, "unexpected argument `b.log`");
}

TEST(CommandLine, ResultsThatCannotBePrintedAreAFailure) {
  const int code = std::system(MASKED_MAPPER_PROGRAM " --help >/dev/full 2>/dev/null");
  EXPECT_EQ(WEXITSTATUS(code), 1);
}

}  // namespace
}  // namespace masked_mapper
