// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace masked_mapper {

/// Calls work(0) ... work(count - 1), each once, on up to `threads` threads. An exception of any is
/// thrown on, once all have ended.
void ForEach(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace masked_mapper
