// Turns glslang's messages into errors with the user's files and lines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "frontend/compile.h"

namespace glint::frontend {

class Includer;

// Names what was compiled: the shader's file, its text, and the options that made the preamble.
struct CompiledText {
  const std::string& path;
  const std::string& text;
  const GlslOptions& options;
};

// Throws UserError when the shader has a version for which glslang prints its own declarations and fails.
void refuse_old_version(const CompiledText& shader);

// Throws what glslang said in `log` as lines of the form "file:line: error: text". Extensions that it does
// not know become an UnsupportedError, and everything else a UserError. `includer` may be null.
[[noreturn]] void throw_messages(const std::string& log, const CompiledText& shader,
                                 const Includer* includer);

}  // namespace glint::frontend
