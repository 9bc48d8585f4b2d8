// Runs commands as processes of their own, a few at a time within a limit of memory, and hears how far each
// is.
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
  std::vector<std::string> arguments;  // of this program, without its name; --progress-fd is added
  std::string log;                     // file for its stdout and stderr
  uint64_t memory = 0;                 // bytes it will need, about
  double weight = 1;                   // of its time: heavy ones start first

  enum class State { Waiting, Running, Done, Failed, Stopped } state = State::Waiting;
  std::string phase = "starting";  // last that it told
  double progress = 0;             // of the phase, 0..1
  double seconds = 0;              // since its start, or that it took
  uint64_t peak_bytes = 0;         // resident, once it has ended
  std::string end;                 // how it ended, if not well: "exit 4", "signal 9"
};

struct PoolLimits {
  uint32_t processes = 1;
  uint64_t memory = 0;  // bytes of all together; 0 = no limit. One that needs more than the limit runs alone.
};

class ProcessPool {
 public:
  ProcessPool(std::vector<Process> processes, const PoolLimits& limits)
      : processes_(std::move(processes)), limits_(limits) {}

  // Called when a process has ended, and now and then between; by index.
  std::function<void(size_t index)> on_end;
  std::function<void()> on_time;  // ten times a second at most

  // Until all have ended; false when SIGINT, SIGTERM or SIGHUP came: what was running then is Stopped.
  bool run();

  const std::vector<Process>& processes() const { return processes_; }
  std::vector<size_t> running() const;
  double elapsed() const { return seconds_since(start_); }
  // Seconds that are left, by weights; below 0: not known yet.
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
  void stop_all();

  std::vector<Process> processes_;
  PoolLimits limits_;
  std::vector<Child> children_;
  Clock::time_point start_ = Clock::now();
  bool interrupted_ = false;
};

}  // namespace glint::app
