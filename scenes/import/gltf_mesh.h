// Reads the triangles of a glTF mesh: accessors of any stride and type become vertices and indices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace tinygltf {
class Model;
}

namespace glint::scenes {

// Says what reading a mesh needs besides its file.
struct MeshOptions {
  // Holds the scene's indices of the file's materials, and one more at the end for primitives that name none.
  const std::vector<int32_t>& materials;
  const std::string& path;  // the file, for messages
  uint32_t threads = 1;     // threads of the host, which do not show in the model
};

// Returns all primitives of the file's mesh `mesh` as one model, in the mesh's own space. Normals are flat
// where the file has none (glTF 2.0, 3.7.2.1). Throws UserError at the file for numbers that name nothing,
// primitives other than triangles, attributes that are not floats, positions that are not finite, and
// accessors that leave their buffers.
Model read_mesh(const tinygltf::Model& file, int mesh, const MeshOptions& options);

}  // namespace glint::scenes
