// SPDX-License-Identifier: BSD-3-Clause
// Items that a thread of its own makes a bounded number ahead of whoever takes them. What is handed
// out, and in which order, does not depend on the threads' timing.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "masked_mapper/log/bounded_queue.hpp"

namespace masked_mapper {

template <typename T>
class RunAhead {
 public:
  /// Takes an item; false when nobody wants any more, and the producer should return.
  using Sink = std::function<bool(T)>;
  /// Runs in the thread. What it throws, Next() throws, behind what was made before.
  using Producer = std::function<void(const Sink&)>;

  RunAhead(std::size_t most_ahead, Producer producer)
      : items_(most_ahead), thread_([this, producer = std::move(producer)] { Run(producer); }) {}
  /// Waits until the producer has returned.
  ~RunAhead() {
    items_.Close();
    thread_.join();
  }
  RunAhead(const RunAhead&) = delete;
  RunAhead& operator=(const RunAhead&) = delete;

  /// Empty when the producer has returned and all that it made is taken.
  std::optional<T> Next() {
    std::optional<T> item = items_.Pop();
    if (!item && error_) std::rethrow_exception(std::exchange(error_, nullptr));
    return item;
  }

 private:
  void Run(const Producer& producer) {
    try {
      producer([this](T item) { return items_.Push(std::move(item)); });
    } catch (...) {
      error_ = std::current_exception();
    }
    items_.Close();
  }

  BoundedQueue<T> items_;
  std::exception_ptr error_;  ///< written before the queue is closed, read after
  std::thread thread_;        ///< the last, since it uses the others
};

}  // namespace masked_mapper
