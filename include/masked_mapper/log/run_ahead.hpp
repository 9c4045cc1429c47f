// SPDX-License-Identifier: BSD-3-Clause
// Items that a thread of its own makes a bounded number ahead of whoever takes them. What is handed
// out, and in which order, does not depend on the threads' timing.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace masked_mapper {

/// Between one producer and one consumer; holds a bounded number of items.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  /// Waits for room; false when nobody will take the item any more.
  bool Push(T item) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || items_.size() < capacity_; });
    if (closed_) return false;
    items_.push_back(std::move(item));
    changed_.notify_all();
    return true;
  }

  /// Waits for an item; empty once the queue is closed and drained.
  std::optional<T> Pop() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !items_.empty(); });
    if (items_.empty()) return std::nullopt;
    T item = std::move(items_.front());
    items_.pop_front();
    changed_.notify_all();
    return item;
  }

  /// From either side: no more items go in.
  void Close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  const std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<T> items_;
  bool closed_ = false;
};

template <typename T>
class RunAhead {
 public:
  /// Takes an item; false when nobody wants any more, and the producer should return.
  using Sink = std::function<bool(T)>;
  /// Runs in the thread. What it throws, Next() throws, behind what was made before.
  using Producer = std::function<void(const Sink&)>;

  /// Small items are handed over `at_once` together, since it takes time to wake a thread; so many
  /// times `most_ahead` are then waiting at most.
  RunAhead(std::size_t most_ahead, Producer producer, std::size_t at_once = 1)
      : at_once_(at_once),
        items_(most_ahead),
        thread_([this, producer = std::move(producer)] { Run(producer); }) {}
  /// Waits until the producer has returned.
  ~RunAhead() {
    items_.Close();
    thread_.join();
  }
  RunAhead(const RunAhead&) = delete;
  RunAhead& operator=(const RunAhead&) = delete;

  /// Empty when the producer has returned and all that it made is taken.
  std::optional<T> Next() {
    while (next_ == taken_.size()) {
      std::optional<std::vector<T>> items = items_.Pop();
      if (!items) {
        if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
        return std::nullopt;
      }
      taken_ = std::move(*items);
      next_ = 0;
    }
    return std::move(taken_[next_++]);
  }

 private:
  void Run(const Producer& producer) {
    std::vector<T> made;
    const auto hand_over = [&] { return items_.Push(std::exchange(made, {})); };
    try {
      producer([&](T item) {
        made.push_back(std::move(item));
        return made.size() < at_once_ || hand_over();
      });
    } catch (...) {
      error_ = std::current_exception();
    }
    if (!made.empty()) hand_over();
    items_.Close();
  }

  const std::size_t at_once_;
  std::vector<T> taken_;
  std::size_t next_ = 0;  ///< of those taken
  BoundedQueue<std::vector<T>> items_;
  std::exception_ptr error_;  ///< written before the queue is closed, read after
  std::thread thread_;        ///< the last, since it uses the others
};

}  // namespace masked_mapper
