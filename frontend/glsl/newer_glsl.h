// Provides GLSL extensions that are newer than the installed glslang, written in GLSL that it knows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "isa/program.h"

namespace glint::frontend {

// Replaces `#extension` lines that enable such an extension by `#include` lines. All lines keep their
// numbers. The process must have initialised glslang, which is asked once what it knows.
void say_extensions_anew(std::string& text);

// Returns the text for such an `#include` line, and an empty text for every other header.
std::string text_of_extension(std::string_view header, isa::Stage stage);

}  // namespace glint::frontend
