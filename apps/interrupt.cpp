// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.hpp"

#include <csignal>

namespace masked_mapper {
namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void Remember(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void CatchInterrupts() {
  std::signal(SIGINT, Remember);
  std::signal(SIGTERM, Remember);
}

void ThrowIfInterrupted() {
  if (interrupted != 0) throw Interrupted("interrupted; nothing was written");
}

bool TakeInterrupt() {
  if (interrupted == 0) return false;
  interrupted = 0;
  CatchInterrupts();
  return true;
}

}  // namespace masked_mapper
