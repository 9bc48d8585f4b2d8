// Looks through a command line for the first word that nothing declares.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/suggest.h"

#include <algorithm>
#include <optional>

#include "base/diagnostics.h"

namespace glint::app {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string did_you_mean(const std::string& guess) {
  return guess.empty() ? "" : "did you mean '" + guess + "'?";
}

}  // namespace

std::string suggestion(const Command& app, const std::vector<std::string>& arguments) {
  std::optional<Command> command;  // the subcommand, once it has been met
  for (size_t i = 1; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(0, word.find('='));
      const std::vector<std::string> options = command.value_or(app).option_names();
      if (!contains(options, name)) return did_you_mean(nearest(name, options));
    } else if (!command) {
      const std::vector<std::string> commands = app.subcommand_names();
      if (!contains(commands, word)) return did_you_mean(nearest(word, commands));
      command = app.subcommand(word);
    }
  }
  return {};
}

}  // namespace glint::app
