// Names what PTX has and Glint has not, so that an error can say which part of PTX is missing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "frontend/ptx/row_names.h"

namespace glint::frontend::ptx {

// Returns the part of PTX that an opcode belongs to, if Glint supports none of that part, or an empty text.
std::string unsupported_part(const Words& words);

// Says whether `.b0` or the like behind a register chooses a byte or a half of it, as video instructions do.
bool is_part_selector(const std::string& element);

}  // namespace glint::frontend::ptx
