// What the command line says of compiling shaders, the same for every subcommand that does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "frontend/cache.h"
#include "frontend/compile.h"
#include "pipeline/structure_cache.h"

namespace glint::app {

struct ShaderOptions {
  std::vector<std::string> include_dirs, defines;
  bool contract = false, no_cache = false;
};

// -I and -D alone; all of them.
void add_source_options(Command command, ShaderOptions& options);
void add_shader_options(Command command, ShaderOptions& options);

// `cache` may be null.
frontend::GlslOptions glsl_options(const ShaderOptions& options, frontend::ShaderCache* cache);

// In $GLINT_CACHE/shaders, $XDG_CACHE_HOME/glint/shaders or ~/.cache/glint/shaders. Null with --no-cache.
std::unique_ptr<frontend::ShaderCache> open_shader_cache(const ShaderOptions& options);

// In the folder `structures` beside it. Null with --no-cache.
std::unique_ptr<pipeline::StructureCache> open_structure_cache(const ShaderOptions& options);

}  // namespace glint::app
