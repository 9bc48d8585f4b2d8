// Handles the signals that stop a launch.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/stop_signals.h"

#include <atomic>

namespace glint::app {
namespace {

// A handler reaches nothing but objects that live as long as the program.
std::atomic<int> taken_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void take_signal(int signal) {
  taken_signal.store(signal, std::memory_order_relaxed);
}

}  // namespace

StopSignals::StopSignals() {
  taken_signal = 0;
  struct sigaction action {};
  action.sa_handler = take_signal;
  action.sa_flags = int(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGINT, &action, &before_interrupt_);
  ::sigaction(SIGTERM, &action, &before_terminate_);
}

StopSignals::~StopSignals() {
  ::sigaction(SIGINT, &before_interrupt_, nullptr);
  ::sigaction(SIGTERM, &before_terminate_, nullptr);
}

int StopSignals::taken() {
  return taken_signal.load(std::memory_order_relaxed);
}

const char* name_of_signal(int signal) {
  return signal == SIGINT ? "SIGINT (Ctrl-C)" : "SIGTERM";
}

}  // namespace glint::app
