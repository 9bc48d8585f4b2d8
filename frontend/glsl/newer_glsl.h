// GLSL extensions that the installed glslang is too old for, said in GLSL that it knows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "isa/program.h"

namespace glint::frontend {

// `#extension` lines that turn such an extension on become `#include` lines; all lines keep their numbers.
void say_extensions_anew(std::string& text);

// What such an `#include` line names; empty for every other header.
std::string text_of_extension(std::string_view header, isa::Stage stage);

}  // namespace glint::frontend
