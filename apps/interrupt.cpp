// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.hpp"

#include <csignal>

namespace masked_mapper {
namespace {

volatile std::sig_atomic_t interrupted = 0;
volatile std::sig_atomic_t requested = 0;

extern "C" void Remember(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

extern "C" void RememberRequest(int /*signal*/) { requested = 1; }

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

void CatchRequests() { std::signal(SIGUSR1, RememberRequest); }

bool TakeRequest() {
  const bool came = requested != 0;
  requested = 0;
  return came;
}

}  // namespace masked_mapper
