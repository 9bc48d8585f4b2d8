// Holds the options for compiling shaders, which are the same for every subcommand that does so.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/plugins.h"
#include "frontend/cache.h"
#include "frontend/compile.h"
#include "pipeline/structure_cache.h"
#include "scenes/scene_store.h"

namespace glint::app {

struct ShaderOptions {
  std::vector<std::string> include_dirs, defines;
  bool contract = false, no_cache = false;
};

// Add -I and -D alone, or all of the options.
void add_source_options(Command command, ShaderOptions& options);
void add_shader_options(Command command, ShaderOptions& options);

// Returns the options of the GLSL compiler. `cache` may be null.
frontend::GlslOptions glsl_options(const ShaderOptions& options, frontend::ShaderCache* cache);

// Opens the cache in $GLINT_CACHE/shaders, $XDG_CACHE_HOME/glint/shaders or ~/.cache/glint/shaders. Returns
// null with --no-cache.
std::unique_ptr<frontend::ShaderCache> open_shader_cache(const ShaderOptions& options);

// Opens the cache in the folder `structures` beside it. Returns null with --no-cache.
// A plugin may bring a node format, so structures of other plugins are not found.
std::unique_ptr<pipeline::StructureCache> open_structure_cache(const ShaderOptions& options,
                                                               const std::vector<Plugin>& plugins);
// Opens the store of scenes in the folder `scenes` beside it. Returns null with --no-cache. Up to `threads`
// threads of the host work for it (0: one for each processor).
std::unique_ptr<scenes::SceneStore> open_scene_store(const ShaderOptions& options, uint32_t threads);

}  // namespace glint::app
