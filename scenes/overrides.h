// Changes parts of a scene after it was loaded, as the command line and run.json name them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// Says what to change: a key and its new value as text.
//   camera.eye, camera.look-at, camera.up   X,Y,Z in world units
//   camera.fov                              vertical field of view in degrees, above 0 and below 180
using Override = std::pair<std::string, std::string>;

// Makes the changes. Throws UserError, which names the option, when a value is not of its key's kind, and
// when no ray can leave the camera that results.
void override_scene(Scene& scene, const std::vector<Override>& overrides);

}  // namespace glint::scenes
