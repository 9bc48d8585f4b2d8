// Suggests the nearest subcommand or option for a word that the command line does not know.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"

namespace glint::app {

// Returns a sentence to print after a parse error, or "" when nothing is near.
std::string suggestion(const Command& app, const std::vector<std::string>& arguments);

}  // namespace glint::app
