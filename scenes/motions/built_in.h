// Declares the motions of generated scenes. At time 0 each of these scenes is as it was loaded.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "scenes/motion.h"

namespace glint::scenes {

// Moves the small spheres of WKND: they hop, and go around the middle, the inner ones faster. Neighbours
// part, as particles do, so that a tree over them ages fast.
std::shared_ptr<const Motion> whirl_of_spheres(const Scene& scene);

// Bends, twists and squashes the largest model of a scene, as jelly does that was pushed.
std::shared_ptr<const Motion> swaying_model(const Scene& scene);

// Lets the camera walk through SPNZA. Nothing else moves.
std::shared_ptr<const Motion> walk_through_sponza(const Scene& scene);

}  // namespace glint::scenes
