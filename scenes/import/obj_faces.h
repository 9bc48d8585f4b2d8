// Reads the elements and faces of an OBJ text with the library, on several threads.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenes/import/obj_chunks.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Names what makes a corner: indices into the lists of an ObjMesh. -1 stands for a corner without one.
struct ObjCorner {
  int32_t position = -1, coordinate = -1, normal = -1;
  int32_t material = 0;  // as the caller numbers materials
  bool operator==(const ObjCorner&) const = default;
};

// Holds the faces of one chunk.
struct ObjFaces {
  std::vector<ObjCorner> corners;   // each is another one; in the order of first use
  std::vector<uint32_t> triangles;  // three per triangle, indices into `corners`; polygons are fans
};

// Holds the elements of a text in its order, and the faces chunk by chunk.
struct ObjMesh {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> coordinates;
  std::vector<ObjFaces> faces;
};

// Reads chunks that checked_chunks() made. A face has the material of the line about materials above it:
// material_of[n] stands for the n-th such line of the text from 1 on, and material_of[0] for a text's
// beginning. Faces with fewer than three corners are left out. Throws UserError when the library sees other
// elements than those that were checked. `path` is for the message. Up to `threads` threads of the host read.
ObjMesh read_obj(std::span<const ObjChunk> chunks, std::span<const int32_t> material_of,
                 const std::string& path, uint32_t threads);

}  // namespace glint::scenes
