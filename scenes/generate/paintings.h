// Paints textures for generated scenes: stone, bricks, planks, panels, cloth, bark, lacquer and leaves.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "scenes/scene.h"

namespace glint::scenes {

enum class Pattern { Stone, Bricks, Planks, Panels, Stripes, Bark, Lacquer };

// Returns an opaque texture. `color` is 0 to 1, and `width` and `height` are in texels. Up to `threads`
// threads of the host paint it.
Texture paint_texture(Pattern pattern, const Vec3& color, uint32_t width, uint32_t height, uint32_t seed,
                      uint32_t threads = 1);
// Returns a picture of a hand of five leaflets. Alpha is exactly 0 outside of them.
Texture paint_leaf(const Vec3& color, uint32_t side, uint32_t seed);

}  // namespace glint::scenes
