// EXPECT: what a buffer must hold.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "amber/script.h"

namespace glint::amber {

// Empty when the buffers are as expected; else what was expected and what was found. UserError when the
// question makes no sense: a place outside of the buffer, a comparison that its type does not have.
std::string check(const Script& script, const Command& command);

}  // namespace glint::amber
