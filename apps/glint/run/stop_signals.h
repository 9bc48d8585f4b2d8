// Notes that a user wants a launch to end: Ctrl-C, or SIGTERM.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <csignal>

namespace glint::app {

// Takes SIGINT and SIGTERM while it lives. The first signal is only noted; a second one ends the process, as
// without this object. There is one object at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static int taken();  // number of the signal that the last of these objects has taken, or 0

 private:
  struct sigaction before_interrupt_ {
  }, before_terminate_{};
};

// Returns the exit code of a command that a signal has ended: 128 and its number, as a shell says it (POSIX).
constexpr int exit_code_of(int signal) {
  return 128 + signal;
}

// Returns what users call a signal: "SIGINT (Ctrl-C)".
const char* name_of_signal(int signal);

}  // namespace glint::app
