// Runs commands as processes, a few at a time within a limit of memory, and hears how far each is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace glint::app {

struct Process {
  std::vector<std::string> arguments;  // arguments for this program, without its name; --progress-fd is added
  std::string log;                     // file for its stdout and stderr
  uint64_t memory = 0;                 // bytes that it will need, estimated
  double weight = 1;                   // relative time that it will take; heavy processes start first

  // Partial says that --max-cycles has ended the run; its results are those up to then.
  enum class State { Waiting, Running, Done, Partial, Failed, Stopped } state = State::Waiting;
  std::string phase = "starting";  // the last phase that the process told
  double progress = 0;             // progress of the phase, 0 to 1
  double seconds = 0;              // seconds since its start, or seconds that it took once it has ended
  uint64_t peak_bytes = 0;         // resident memory, known once it has ended
  std::string end;                 // how it ended when it did not end well: "exit 4", "signal 9"
};

struct PoolLimits {
  uint32_t processes = 1;
  // These are the bytes that all processes may take together; 0 sets no limit. A process that needs more than
  // the limit runs alone.
  uint64_t memory = 0;
};

class ProcessPool {
 public:
  ProcessPool(std::vector<Process> processes, const PoolLimits& limits)
      : processes_(std::move(processes)), limits_(limits) {}

  // Is called with a process's index when the process has ended, and from time to time in between.
  std::function<void(size_t index)> on_end;
  std::function<void()> on_time;  // is called at most ten times a second

  // Runs until all processes have ended. Returns 0, or the number of the signal (SIGINT, SIGTERM or SIGHUP)
  // that ended it early. Processes that were running then are Stopped.
  int run();

  const std::vector<Process>& processes() const { return processes_; }
  std::vector<size_t> running() const;
  double elapsed() const { return seconds_since(start_); }
  // Returns the estimated seconds that are left, by weights. A value below 0 says that they are not known
  // yet.
  double time_left() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Child {
    size_t index;
    int pid, pipe;
    Clock::time_point start;
    std::string text;  // an unfinished line
  };
  static double seconds_since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  }

  void start_what_fits();
  bool start(size_t index);
  void listen(int signals);
  void hear(Child& child);
  void reap();
  void end(size_t child, int status, uint64_t peak_bytes);
  void stop_all(int signal);

  std::vector<Process> processes_;
  PoolLimits limits_;
  std::vector<Child> children_;
  Clock::time_point start_ = Clock::now();
  int stopped_by_ = 0;  // number of the first signal that came, or 0
};

}  // namespace glint::app
