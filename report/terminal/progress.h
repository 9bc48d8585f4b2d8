// Draws a progress line with an estimate of the time left, in place. It is silent when stdout is not a
// terminal.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

#include "report/terminal/table.h"

namespace glint::report {

// Counts what a launch has done. It moves on even while no part of the whole is done.
struct Work {
  uint64_t cycles = 0, instructions = 0;
  std::string at{};  // the source line where most of it goes on, or nothing
};

// Returns the line for `done` of `total` after `elapsed` seconds, without control characters. Cycles,
// instructions per second and the source line are in it when there are some. What is wider than a terminal
// loses the estimate first, and then the bar.
std::string progress_line(const std::string& label, uint64_t done, uint64_t total, double elapsed,
                          const Terminal& terminal, const Work& work = {});

// Redraws at most ten times a second, so an update usually costs only a clock read.
class Progress {
 public:
  // A null `stream` shows nothing.
  Progress(std::FILE* stream, std::string label, Terminal terminal);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `source_line()` says what Work::at is. It is asked where nothing more was done for some seconds.
  void update(uint64_t done, uint64_t total, Work work = {},
              const std::function<std::string()>& source_line = {});
  void clear();  // wipes the line, so that the next text starts on a clean one

 private:
  using Clock = std::chrono::steady_clock;
  std::FILE* stream_;
  std::string label_;
  Terminal terminal_;
  Clock::time_point start_, last_, moved_;  // `moved_` is when `done_` grew last
  uint64_t done_ = 0;
  size_t drawn_ = 0;  // columns on the screen
};

}  // namespace glint::report
