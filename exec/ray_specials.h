// Writes what a shader reads of its ray, its hit, its payload and its record of the binding table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/warp_context.h"

namespace glint::exec {

// Writes the special registers of the lanes, which run `shader` in the warp's present level of traces and
// callables.
void fill_specials(const World& world, WarpContext& warp, LaneMask lanes, const Shader& shader);

// Writes the special registers for all running lanes, in the shader that the warp is in.
inline void refill_specials(const World& world, WarpContext& warp) {
  fill_specials(world, warp, warp.simt.active, world.image->shaders[world.image->shader_of[warp.simt.pc]]);
}

}  // namespace glint::exec
