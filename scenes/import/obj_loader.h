// Reads Wavefront OBJ files as models, by the rules of LumiBench's application.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/lookup.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Says what load_obj() reads beside a model, and how.
struct ObjReading {
  // Every material that names a map_Kd gets a texture of its own here, even where two materials name the same
  // file, and a black Kd becomes white. Null: textures are not read.
  std::vector<Texture>* textures = nullptr;
  std::vector<std::string>* names = nullptr;  // gets the materials' names in the file, unless it is null
  uint32_t threads = 1;                       // threads of the host; they do not show in the model
  size_t chunk_bytes = 4 << 20;               // text that a thread reads at a time; does not show either
  LookupLog* log = nullptr;                   // gets the paths of libraries and textures, unless it is null
};

// Loads one file as one model and appends its materials to `materials`. The rules are:
//  - Polygons become fans.
//  - Each distinct (position, normal, coordinate, material) becomes one vertex, in the order of first use.
//  - v is stored as 1 - v.
//  - Normals are smooth when the file has none.
//  - Materials are Lambertian with colour Kd; a file without a material library has one of grey 0.7.
//  - A file that was cut into parts, FILE.aa FILE.ab ..., is read as one when FILE itself does not exist.
// Throws UserError when the file, its library or a texture cannot be read.
Model load_obj(const std::string& path, std::vector<Material>& materials, const ObjReading& reading = {});

// Returns the materials of an MTL file by the same rules, without textures.
std::vector<Material> load_materials(const std::string& path);

// Returns the parts of a file that was cut, in order, or nothing when there are none.
std::vector<std::string> parts_of(const std::string& path);

}  // namespace glint::scenes
