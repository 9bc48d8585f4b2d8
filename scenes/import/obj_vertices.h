// Makes a model of an OBJ mesh: equal corners become one vertex.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "scenes/import/obj_faces.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Returns the mesh's triangles. Each distinct (position, normal, coordinate, material) becomes one vertex, in
// the order of first use, whichever numbers the file gives it, and v is stored as 1 - v. The mesh is used up.
// Up to `threads` threads of the host work; they do not show in the model.
Model model_of(ObjMesh mesh, uint32_t threads);

}  // namespace glint::scenes
