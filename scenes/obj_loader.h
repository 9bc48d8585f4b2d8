// Wavefront OBJ files as models, by the rules of LumiBench's application.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// The first of `candidates` (paths below `assets`) that exists, joined to `assets`.
// UserError that names every place when none does; `scene` is for the message.
std::string find_asset(const std::string& assets, const std::string& scene,
                       const std::vector<std::string>& candidates);

// Loads one file as one model and appends its materials to `materials` (textures are not read; no scene here has
// any). Polygons become fans; one vertex a distinct (position, normal, coordinate, material), in the order of first
// use; v is stored as 1 - v; smooth normals when the file has none; materials are Lambertian of Kd; a file without
// a material library has one grey 0.7. UserError when the file or its library cannot be read.
Model load_obj(const std::string& path, std::vector<Material>& materials);

}  // namespace glint::scenes
