// Finds the Python package and starts a program of it.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/python_package.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>
#include <vector>

#include "base/diagnostics.h"

namespace glint::app {

void add_python_option(Command command, std::string& python) {
  command.add_option("--python", python, "Python to use: 3.11 or newer")
      .envname("GLINT_PYTHON")
      .capture_default_str();
}

Exit hand_over(const Session& session, const std::string& python, const std::string& module,
               const std::string& command) {
  const std::string package = session.resources.python_dir();
  if (!package.empty()) {
    const char* before = std::getenv("PYTHONPATH");
    const std::string path = before && *before ? package + ":" + before : package;
    ::setenv("PYTHONPATH", path.c_str(), 1);
  }
  char program[4096];
  const ssize_t length = ::readlink("/proc/self/exe", program, sizeof program - 1);
  if (length > 0) ::setenv("GLINT", std::string(program, size_t(length)).c_str(), 1);
  std::vector<std::string> words = {python, "-m", module};
  bool after = false;
  for (const std::string& word : session.arguments) {
    if (after) words.push_back(word);
    after = after || word == command;
  }
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(pointers[0], pointers.data());
  throw UserError({}, fmt::format("cannot start '{}': {}", python, std::strerror(errno)),
                  fmt::format("`glint {}` needs Python 3.11 or newer; --python names another one", command));
}

}  // namespace glint::app
