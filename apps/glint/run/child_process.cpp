// Runs another program in the foreground, as a shell does.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "apps/glint/run/stop_signals.h"
#include "base/diagnostics.h"

namespace glint::app {
namespace {

constexpr timespec kBetweenCalls{0, 200'000'000};

// Holds back the signals that end a process while it lives.
class HeldSignals {
 public:
  HeldSignals() {
    ::sigemptyset(&held_);
    for (const int each : {SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGCHLD}) ::sigaddset(&held_, each);
    ::sigprocmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  const sigset_t& before() const { return before_; }
  // Waits a moment for one. Returns its number, or -1.
  int wait() const { return ::sigtimedwait(&held_, nullptr, &kBetweenCalls); }

 private:
  sigset_t held_{}, before_{};
};

pid_t start(const std::vector<std::string>& command, const sigset_t& mask) {
  std::vector<std::string> words = command;
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t ours;  // The command ignores this one (main.cpp), and a program may not expect that.
  ::sigemptyset(&ours);
  ::sigaddset(&ours, SIGXFSZ);
  ::posix_spawnattr_setsigdefault(&attributes, &ours);
  ::posix_spawnattr_setsigmask(&attributes, &mask);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t process = 0;
  const int error = ::posix_spawnp(&process, pointers[0], nullptr, &attributes, pointers.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  if (error)
    throw UserError({},
                    fmt::format("cannot start '{}': {}", command[0], std::generic_category().message(error)),
                    "is its name spelled rightly, and is it an executable file?");
  return process;
}

}  // namespace

int run_child(const std::vector<std::string>& command,
              const std::vector<std::pair<std::string, std::string>>& variables,
              const std::function<void()>& while_running) {
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  const HeldSignals signals;
  const pid_t process = start(command, signals.before());
  for (int status = 0;;) {
    const pid_t ended = ::waitpid(process, &status, WNOHANG);
    if (ended == process && WIFEXITED(status)) return WEXITSTATUS(status);
    if (ended == process && WIFSIGNALED(status)) return exit_code_of(WTERMSIG(status));
    if (ended < 0 && errno != EINTR) return exit_code_of(0);
    const int signal = signals.wait();
    if (signal == SIGTERM || signal == SIGHUP) ::kill(process, signal);
    while_running();
  }
}

}  // namespace glint::app
