// Names a scene's contents by 64 bits.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "scenes/scene.h"

namespace glint::scenes {

// Returns a hash of everything that reaches a shader, on up to `threads` threads of the host. It is the same
// at any number of threads, in every run and on every machine.
uint64_t scene_hash(const Scene& scene, uint32_t threads);

}  // namespace glint::scenes
