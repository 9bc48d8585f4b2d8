// Changes parts of a scene after it was loaded, as the command line and run.json name them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// Says what to change: a key and its new value as text.
//   camera.eye, camera.look-at, camera.up   X,Y,Z in world units
//   camera.fov                              vertical field of view in degrees, above 0 and below 180
//   light.sky                               on or off
//   light.position, light.radius            X,Y,Z and a length in world units; only without a sky
//   material.NAME.KEY                       NAME is the number or the name of materials; see material_keys()
using Override = std::pair<std::string, std::string>;

// Returns the keys of a material: what can be changed, and the form of its values.
std::vector<std::pair<std::string_view, std::string_view>> material_keys();

// Return the changes that the texts of options ask for: "KEY=VALUE" of the light, and "NAME.KEY=VALUE" of a
// material. A name may hold dots. Throw UserError for texts of another form.
Override light_override(const std::string& text);
Override material_override(const std::string& text);

// Makes the changes. Throws UserError, which names the option, when a value is not of its key's kind, when
// the scene has no such material, when the light has no effect, and when no ray can leave the camera that
// results.
void override_scene(Scene& scene, const std::vector<Override>& overrides);

// Returns why no ray can leave a camera, or "": it looks at its own place or along its upward direction, or
// is out of range. `note` gets which option mends it.
std::string why_blind(const Camera& camera, std::string* note = nullptr);

std::string_view name_of(MaterialModel model);  // "lambertian", "metallic", ...

}  // namespace glint::scenes
