// SPDX-License-Identifier: BSD-3-Clause
// Runs the program as a user would and keeps what it said.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

namespace masked_mapper {

struct Ran {
  int code = -1;  ///< exit code; -1 when it was killed by a signal
  std::string out;
  std::string err;
};

struct RunSettings {
  rlim_t largest_file = RLIM_INFINITY;  ///< bytes; a write beyond fails, as on a full disk
  bool terminal = false;                ///< standard error is a terminal
  bool interrupt = false;               ///< Ctrl-C as soon as it says anything
  int kill_after_ms = 0;                ///< end it without a warning; 0: do not
};

/// A bare chroot has none.
inline bool HasPseudoTerminals() {
  int ends[2] = {-1, -1};
  if (openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) != 0) return false;
  for (const int end : ends) close(end);
  return true;
}

/// Reads until all are closed; calls `spoken` once, when the first byte has come.
inline void ReadAllOf(std::vector<std::pair<int, std::string*>> sources,
                      std::function<void()> spoken) {
  while (!sources.empty()) {
    std::vector<pollfd> polled;
    for (const auto& source : sources) polled.push_back({source.first, POLLIN, 0});
    if (poll(polled.data(), polled.size(), -1) < 0) return;
    for (std::size_t i = polled.size(); i-- > 0;) {
      if (polled[i].revents == 0) continue;
      char buffer[4096];
      const ssize_t got = read(polled[i].fd, buffer, sizeof buffer);
      if (got > 0) {
        sources[i].second->append(buffer, static_cast<std::size_t>(got));
        if (spoken) spoken();
        spoken = nullptr;
      } else {
        close(polled[i].fd);
        sources.erase(sources.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }
}

inline Ran RunProgram(const std::vector<std::string>& arguments, const RunSettings& settings = {}) {
  int out[2] = {-1, -1};
  int err[2] = {-1, -1};
  EXPECT_EQ(pipe(out), 0);
  if (settings.terminal) {
    EXPECT_EQ(openpty(&err[0], &err[1], nullptr, nullptr, nullptr), 0);
  } else {
    EXPECT_EQ(pipe(err), 0);
  }
  std::vector<char*> words = {const_cast<char*>(MASKED_MAPPER_PROGRAM)};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    for (const int fd : {out[0], out[1], err[0], err[1]}) close(fd);
    if (settings.largest_file != RLIM_INFINITY) {
      const rlimit limit{settings.largest_file, settings.largest_file};
      setrlimit(RLIMIT_FSIZE, &limit);
      std::signal(SIGXFSZ, SIG_IGN);
    }
    // The kernel's timer outlives the exec, and its signal ends a program that does not know it.
    if (settings.kill_after_ms > 0) {
      const itimerval timer{{0, 0}, {0, 1000 * settings.kill_after_ms}};
      setitimer(ITIMER_REAL, &timer, nullptr);
    }
    execv(words[0], words.data());
    _exit(127);
  }
  close(out[1]);
  close(err[1]);
  Ran ran;
  ReadAllOf({{out[0], &ran.out}, {err[0], &ran.err}}, [&] {
    if (settings.interrupt) kill(child, SIGINT);
  });
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) ran.code = WEXITSTATUS(status);
  return ran;
}

/// An empty folder of one test, removed afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = ::testing::TempDir() + "masked_mapper_XXXXXX";
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Everything in it, sorted, relative.
  std::vector<std::string> Listing() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) {
      names.push_back(entry.path().lexically_relative(path_).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string ReadText(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline long LinesIn(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

inline bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Exit code 2, one line that says what is wrong, and nothing new on disk.
inline void ExpectUsersFault(const ScratchFolder& folder, const std::vector<std::string>& arguments,
                             const std::string& said) {
  const std::vector<std::string> before = folder.Listing();
  const Ran ran = RunProgram(arguments);
  EXPECT_EQ(ran.code, 2) << ran.err;
  EXPECT_EQ(ran.out, "");
  // Progress may come first; what is wrong is the last line, and the only one of its kind.
  const std::string last = ran.err.substr(ran.err.rfind('\n', ran.err.size() - 2) + 1);
  EXPECT_EQ(last.rfind("masked_mapper: ", 0), 0U) << ran.err;
  EXPECT_TRUE(Contains(last, said)) << "expected `" << said << "` in: " << ran.err;
  EXPECT_EQ(folder.Listing(), before);
}

}  // namespace masked_mapper
