// Forks, listens and reaps. Signals come through a descriptor, so that nothing runs inside of a handler.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/process_pool.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/glint/run/recorded_run.h"
#include "base/diagnostics.h"

namespace glint::app {
namespace {

constexpr std::chrono::milliseconds kWakeUp{100};  // between looks at the clock

sigset_t watched_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&set, signal);
  return set;
}

// Runs in the child between fork and exec, where only system calls are allowed.
[[noreturn]] void become(char* const* arguments, const char* log, int pipe) {
  const sigset_t set = watched_signals();
  ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
  ::setpgid(0, 0);                     // Ctrl-C goes only to the parent, who decides.
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // The child ends when the parent dies.
  const int out = ::open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666), in = ::open("/dev/null", O_RDONLY);
  if (out >= 0 && in >= 0) {
    ::dup2(in, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(out, STDERR_FILENO);
    ::fcntl(pipe, F_SETFD, 0);
    ::execv("/proc/self/exe", arguments);
  }
  ::_exit(127);
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("signal {}{}", WTERMSIG(status),
                       WTERMSIG(status) == SIGKILL ? ", perhaps out of memory" : "");
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("exit {}", WEXITSTATUS(status));
}

}  // namespace

std::vector<size_t> ProcessPool::running() const {
  std::vector<size_t> out;
  for (const Child& child : children_) out.push_back(child.index);
  return out;
}

double ProcessPool::time_left() const {
  double done = 0, all = 0;
  for (const Process& process : processes_) {
    const bool ended = process.state != Process::State::Waiting && process.state != Process::State::Running;
    const double part = ended ? 1.0 : process.phase == "rendering" ? process.progress : 0.0;
    all += process.weight;
    done += part * process.weight;
  }
  if (done < 0.01 * all) return -1;
  return elapsed() * (all - done) / done;
}

int ProcessPool::run() {
  const sigset_t set = watched_signals();
  sigset_t before;
  ::sigprocmask(SIG_BLOCK, &set, &before);
  const int signals = ::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  start_ = Clock::now();
  Clock::time_point told{};
  for (;;) {
    if (!stopped_by_) start_what_fits();
    if (children_.empty()) break;
    listen(signals);
    reap();
    for (const Child& child : children_) processes_[child.index].seconds = seconds_since(child.start);
    if (!on_time || Clock::now() - told < kWakeUp) continue;
    told = Clock::now();
    on_time();
  }
  ::close(signals);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  return stopped_by_;
}

// Starts the heaviest waiting processes that fit beside the running ones.
void ProcessPool::start_what_fits() {
  while (children_.size() < limits_.processes) {
    uint64_t used = 0;
    for (const Child& child : children_) used += processes_[child.index].memory;
    size_t best = processes_.size();
    for (size_t i = 0; i < processes_.size(); ++i) {
      const Process& process = processes_[i];
      const bool fits = limits_.memory == 0 || children_.empty() || used + process.memory <= limits_.memory;
      if (process.state == Process::State::Waiting && fits &&
          (best == processes_.size() || process.weight > processes_[best].weight))
        best = i;
    }
    if (best == processes_.size() || !start(best)) return;
  }
}

bool ProcessPool::start(size_t index) {
  Process& process = processes_[index];
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(Exit::Failure, "cannot make a pipe for another process");
  std::vector<std::string> words = {"glint"};
  words.insert(words.end(), process.arguments.begin(), process.arguments.end());
  words.push_back(fmt::format("--progress-fd={}", ends[1]));
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid == 0) become(pointers.data(), process.log.c_str(), ends[1]);
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    if (children_.empty()) throw Error(Exit::Failure, "cannot start a process");
    limits_.processes = uint32_t(children_.size());  // The system allows no more than these.
    return false;
  }
  ::setpgid(pid, pid);  // Parent and child both set the group, because either may come first.
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  children_.push_back({index, pid, ends[0], Clock::now(), {}});
  process.state = Process::State::Running;
  return true;
}

void ProcessPool::listen(int signals) {
  std::vector<pollfd> watched = {{signals, POLLIN, 0}};
  for (const Child& child : children_) watched.push_back({child.pipe, POLLIN, 0});
  if (::poll(watched.data(), watched.size(), int(kWakeUp.count())) <= 0) return;
  signalfd_siginfo info;
  while (::read(signals, &info, sizeof info) == ssize_t(sizeof info))
    if (info.ssi_signo != uint32_t(SIGCHLD)) stop_all(int(info.ssi_signo));
  bool is_hung_up = false;
  for (size_t i = 0; i < children_.size(); ++i) {
    if (watched[i + 1].revents & POLLIN) hear(children_[i]);
    is_hung_up |= (watched[i + 1].revents & POLLHUP) != 0;
  }
  if (is_hung_up) ::usleep(10000);  // The child is about to end, so this avoids busy waiting.
}

void ProcessPool::hear(Child& child) {
  char buffer[4096];
  const ssize_t got = ::read(child.pipe, buffer, sizeof buffer);
  if (got <= 0) return;
  child.text.append(buffer, size_t(got));
  Process& process = processes_[child.index];
  for (size_t end = child.text.find('\n'); end != std::string::npos; end = child.text.find('\n')) {
    const std::string line = child.text.substr(0, end);
    child.text.erase(0, end + 1);
    const size_t space = line.find(' ');
    uint32_t thousandths = 0;
    if (space == std::string::npos ||
        std::from_chars(line.data() + space + 1, line.data() + line.size(), thousandths).ec != std::errc{})
      continue;
    process.phase = line.substr(0, space);
    process.progress = std::min(1.0, thousandths / 1000.0);
  }
}

void ProcessPool::reap() {
  for (size_t i = children_.size(); i-- > 0;) {
    int status = 0;
    rusage usage{};
    if (::wait4(children_[i].pid, &status, WNOHANG, &usage) != children_[i].pid) continue;
    end(i, status, uint64_t(usage.ru_maxrss) * 1024);  // ru_maxrss is in KiB (getrusage(2)).
  }
}

void ProcessPool::end(size_t at, int status, uint64_t peak_bytes) {
  const Child child = children_[at];
  children_.erase(children_.begin() + std::ptrdiff_t(at));
  ::close(child.pipe);
  Process& process = processes_[child.index];
  process.seconds = seconds_since(child.start);
  process.peak_bytes = peak_bytes;
  process.end = how_it_ended(status);
  const bool is_partial = WIFEXITED(status) && WEXITSTATUS(status) == int(kReachedMaxCycles);
  process.state = process.end.empty() ? Process::State::Done
                  : is_partial        ? Process::State::Partial
                  : stopped_by_       ? Process::State::Stopped
                                      : Process::State::Failed;
  if (on_end) on_end(child.index);
}

void ProcessPool::stop_all(int signal) {
  if (!stopped_by_) stopped_by_ = signal;
  for (const Child& child : children_) ::kill(child.pid, SIGTERM);
}

}  // namespace glint::app
