// Hashes the contents of a scene, for Scene::hash() and for who keeps scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// Returns the hashes of the parts that vertices, indices and texels are cut into, in order. Up to `threads`
// threads of the host work (0: one for each processor); they do not show.
std::vector<uint64_t> content_hashes(const Scene& scene, uint32_t threads);

}  // namespace glint::scenes
