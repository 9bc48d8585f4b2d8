// Triangles of a glTF mesh: accessors of any stride and type as vertices and indices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace tinygltf {
class Model;
struct Mesh;
}  // namespace tinygltf

namespace glint::scenes {

// All primitives of a mesh as one model, in the mesh's own space. `materials` are the scene's indices of the
// file's materials, one more at the end for primitives that name none. Normals are flat where the file has
// none (glTF 2.0, 3.7.2.1). UserError at `path`: primitives other than triangles, attributes that are not of
// floats, accessors that leave their buffers; std::out_of_range: an index names nothing.
Model read_mesh(const tinygltf::Model& file, const tinygltf::Mesh& mesh,
                const std::vector<int32_t>& materials, const std::string& path);

}  // namespace glint::scenes
