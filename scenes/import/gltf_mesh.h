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

// Says which vertices of a model came from a primitive of its mesh.
struct PrimitiveOrigin {
  uint32_t first_vertex = 0;  // of the model
  uint32_t vertices = 0;      // of the primitive
  // The primitive's vertex of each of the model's, where the primitive has no normals: then each triangle has
  // corners of its own. Empty: they are those of the primitive, in order.
  std::vector<uint32_t> corners;
};

// Returns all primitives of the file's mesh `mesh` as one model, in the mesh's own space. Normals are flat
// where the file has none (glTF 2.0, 3.7.2.1). Throws UserError at the file for numbers that name nothing,
// primitives other than triangles, attributes that are not floats, positions that are not finite, and
// accessors that leave their buffers. `origins` gets an element for each primitive.
Model read_mesh(const tinygltf::Model& file, int mesh, const MeshOptions& options,
                std::vector<PrimitiveOrigin>* origins = nullptr);

}  // namespace glint::scenes
