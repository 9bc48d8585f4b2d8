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

// Loads one file as one model and appends its materials to `materials`. Polygons become fans; one vertex a
// distinct (position, normal, coordinate, material), in the order of first use; v is stored as 1 - v; smooth
// normals when the file has none; materials are Lambertian of Kd; a file without a material library has one
// grey 0.7. With `textures` every material that names a map_Kd gets a texture of its own, also where two name
// the same file, and a black Kd becomes white. A file cut into parts, FILE.aa FILE.ab ..., is read as one
// when FILE itself is not there. UserError when the file, its library or a texture cannot be read.
Model load_obj(const std::string& path, std::vector<Material>& materials,
               std::vector<Texture>* textures = nullptr);

// Materials of an MTL file by the same rules, without textures.
std::vector<Material> load_materials(const std::string& path);

// The parts of a file that was cut, in order; empty when there are none.
std::vector<std::string> parts_of(const std::string& path);

}  // namespace glint::scenes
