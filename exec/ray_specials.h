// Writes what a shader reads of its ray, its hit, its payload and its record of the binding table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/warp_context.h"

namespace glint::exec {

// Shaders read the flags of their trace without those that the pipeline added. A ray keeps in its upper bits,
// which are no flags, which of the added ones its trace had itself.
inline constexpr int kOwnFlagsShift = 16;
inline uint32_t with_added_flags(const World& world, uint32_t own) {
  return own | world.added_ray_flags | (own & world.added_ray_flags) << kOwnFlagsShift;
}
inline uint32_t own_flags(const World& world, uint32_t flags) {
  if (!world.added_ray_flags) return flags;
  return (flags & ~world.added_ray_flags & ((1u << kOwnFlagsShift) - 1)) | flags >> kOwnFlagsShift;
}

// Writes the special registers of the lanes, which run `shader` in the warp's present level of traces and
// callables.
void fill_specials(const World& world, WarpContext& warp, LaneMask lanes, const Shader& shader);

// Writes the special registers for all running lanes, in the shader that the warp is in.
inline void refill_specials(const World& world, WarpContext& warp) {
  fill_specials(world, warp, warp.simt.active, world.image->shaders[world.image->shader_of[warp.simt.pc]]);
}

}  // namespace glint::exec
