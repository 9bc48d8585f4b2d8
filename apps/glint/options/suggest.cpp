// Looks through a command line for the first word that nothing declares.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/suggest.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/diagnostics.h"

namespace glint::app {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string did_you_mean(const std::string& guess) {
  return guess.empty() ? "" : "did you mean '" + guess + "'?";
}

}  // namespace

std::string suggestion(const CLI::App& app, const std::vector<std::string>& arguments) {
  const std::vector<std::string> commands = command_names(app);
  const CLI::App* command = &app;
  for (size_t i = 1; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(0, word.find('='));
      const std::vector<std::string> options = option_names(*command);
      if (!contains(options, name)) return did_you_mean(nearest(name, options));
    } else if (command == &app) {
      if (!contains(commands, word)) return did_you_mean(nearest(word, commands));
      command = app.get_subcommand(word);
    }
  }
  return {};
}

}  // namespace glint::app
