// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and a polite kill: the work ends at its next step, and what was half-written is removed.
#pragma once

#include <exception>

namespace masked_mapper {

/// Thrown from where the work looks whether it was interrupted.
class Interrupted : public std::exception {};

/// From now on SIGINT and SIGTERM are remembered; a second one ends the program at once.
void CatchInterrupts();

/// Throws Interrupted when one came.
void ThrowIfInterrupted();

}  // namespace masked_mapper
