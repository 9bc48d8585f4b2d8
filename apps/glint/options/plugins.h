// Loads policies that were built apart from Glint, as shared libraries.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"

namespace glint::app {

// Names a loaded library.
struct Plugin {
  std::string path;   // absolute path of the library
  uint64_t hash = 0;  // hash of the file's bytes
};

// Adds `--plugin`, which any subcommand takes too. Its default is the environment variable GLINT_PLUGINS.
void add_plugin_option(Command app, std::vector<std::string>& files);

// Loads each file, so that its policies are registered. The libraries stay until the process ends. Throws
// UserError when a file is not a plugin, was built against other headers than this program, cannot be linked,
// registers a name that is taken, or registers nothing.
std::vector<Plugin> load_plugins(const std::vector<std::string>& files);

// Returns a text that identifies the files and their contents, or "" without plugins. Caches and resumed
// suites compare it.
std::string identity_of(const std::vector<Plugin>& plugins);

}  // namespace glint::app
