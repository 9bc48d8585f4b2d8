// Replaces this process by a program of the Python package, which does the work of some commands.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/options/command_line.h"
#include "apps/glint/session.h"

namespace glint::app {

// Declares --python, which names the interpreter.
void add_python_option(Command command, std::string& python);

// Starts `python -m module` with the words that followed `command` on this program's command line, in this
// process, so that Ctrl-C reaches it. Throws UserError when there is no such interpreter.
Exit hand_over(const Session& session, const std::string& python, const std::string& module,
               const std::string& command);

}  // namespace glint::app
