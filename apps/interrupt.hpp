// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and a polite kill: the work ends at its next step, and what was half-written is removed.
#pragma once

#include <stdexcept>

namespace masked_mapper {

/// Thrown from where the work looks whether it was interrupted. Says what became of the work.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// From now on SIGINT and SIGTERM are remembered; a second one ends the program at once.
void CatchInterrupts();

/// Throws Interrupted when one came.
void ThrowIfInterrupted();

/// Whether one came; it counts no longer, and the next one is remembered again. For who listens to
/// a robot until it is told to stop.
bool TakeInterrupt();

/// From now on SIGUSR1 asks for the map so far, and ends the program no longer.
void CatchRequests();

/// Whether one came since the last time.
bool TakeRequest();

}  // namespace masked_mapper
