// SPDX-License-Identifier: BSD-3-Clause
// Work on items that a thread of its own does behind whoever hands them over, in their order, a
// bounded number of them at most waiting. Without a thread it is done at once.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "masked_mapper/log/run_ahead.hpp"

namespace masked_mapper {

template <typename T>
class WorkBehind {
 public:
  using Work = std::function<void(const T&)>;

  WorkBehind(std::size_t most_waiting, bool in_thread, Work work)
      : work_(std::move(work)), items_(most_waiting) {
    if (in_thread) thread_ = std::thread([this] { Run(); });
  }
  /// What was not worked on yet is forgotten, unless Finish() was called.
  ~WorkBehind() {
    is_given_up_ = true;
    Join();
  }
  WorkBehind(const WorkBehind&) = delete;
  WorkBehind& operator=(const WorkBehind&) = delete;

  void Add(T item) {
    if (thread_.joinable()) {
      items_.Push(std::move(item));
    } else {
      work_(item);
    }
  }

  /// Waits until all is done. Throws what the work threw; nothing is added afterwards.
  void Finish() {
    Join();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  void Join() {
    items_.Close();
    if (thread_.joinable()) thread_.join();
  }

  void Run() {
    try {
      while (const std::optional<T> item = items_.Pop()) {
        if (!is_given_up_) work_(*item);
      }
    } catch (...) {
      error_ = std::current_exception();
      items_.Close();
    }
  }

  Work work_;
  BoundedQueue<T> items_;
  std::atomic<bool> is_given_up_ = false;
  std::exception_ptr error_;  ///< written before the thread ends, read after
  std::thread thread_;        ///< the last, since it uses the others
};

}  // namespace masked_mapper
