// Runs another program in the foreground, as a shell does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace glint::app {

// Runs a program with this process's streams and environment, and `variables` on top. Ctrl-C is for the
// program alone, and SIGTERM is passed on to it. Calls `while_running` several times a second. Returns the
// exit code; a signal that ends the program gives 128 and its number. Throws UserError when it cannot be
// started.
int run_child(const std::vector<std::string>& command,
              const std::vector<std::pair<std::string, std::string>>& variables,
              const std::function<void()>& while_running);

}  // namespace glint::app
