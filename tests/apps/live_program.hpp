// SPDX-License-Identifier: BSD-3-Clause
// The program while it runs: bytes go to its standard input, signals to it, and it is waited for.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "apps/program.hpp"

namespace masked_mapper {

/// False when it did not come true within a minute, which is a failure, not a measurement.
inline bool ComesTrue(const std::function<bool()>& condition) {
  constexpr int kLooks = 1200;
  for (int look = 0; look < kLooks; ++look) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

class LiveProgram {
 public:
  /// What it says on standard output and error goes to files in `folder`.
  LiveProgram(const std::vector<std::string>& arguments, const ScratchFolder& folder)
      : out_(folder / "said.out"), err_(folder / "said.err") {
    int input[2] = {-1, -1};
    EXPECT_EQ(pipe2(input, O_CLOEXEC), 0);
    std::vector<char*> words = {const_cast<char*>(MASKED_MAPPER_PROGRAM)};
    for (const std::string& argument : arguments) {
      words.push_back(const_cast<char*>(argument.c_str()));
    }
    words.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      dup2(input[0], STDIN_FILENO);
      const int out = open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      const int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      dup2(out, STDOUT_FILENO);
      dup2(err, STDERR_FILENO);
      execv(words[0], words.data());
      _exit(127);
    }
    close(input[0]);
    input_ = input[1];
  }
  ~LiveProgram() {
    if (child_ < 0) return;
    Signal(SIGKILL);
    End();
  }
  LiveProgram(const LiveProgram&) = delete;
  LiveProgram& operator=(const LiveProgram&) = delete;

  /// It has taken all of it when this returns, but for what the pipe holds.
  void Write(const std::string& bytes) const {
    std::size_t written = 0;
    while (written < bytes.size()) {
      const ssize_t count = write(input_, bytes.data() + written, bytes.size() - written);
      ASSERT_GT(count, 0);
      written += static_cast<std::size_t>(count);
    }
  }
  void Signal(int signal) const { kill(child_, signal); }
  std::string Out() const { return ReadText(out_); }
  std::string Err() const { return ReadText(err_); }

  /// Its standard input is over; the exit code, -1 when a signal ended it.
  int End() {
    close(input_);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::string out_;
  std::string err_;
  pid_t child_ = -1;
  int input_ = -1;
};

}  // namespace masked_mapper
