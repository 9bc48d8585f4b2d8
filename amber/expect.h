// Checks EXPECT, which says what a buffer must hold.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "amber/script.h"

namespace glint::amber {

// Returns an empty text when the buffers are as expected, and otherwise what was expected and what was found.
// Throws UserError when the command makes no sense: its place is outside the buffer, or the buffer's type
// does not have its comparison.
std::string check(const Script& script, const Command& command);

}  // namespace glint::amber
