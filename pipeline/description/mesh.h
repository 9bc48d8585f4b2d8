// Loads triangle meshes from files, for geometries and for the buffers that shaders read beside them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/description/description.h"
#include "scenes/scene.h"

namespace glint::pipeline {

// Loads OBJ or glTF (.gltf, .glb; all of its scene in world coordinates). Throws UserError when the file
// cannot be read. Up to `threads` threads of the host read it, which do not show in the model.
scenes::Model load_mesh(const std::string& path, const SourceLocation& where, uint32_t threads = 1);

// Returns the bytes of an attribute. Positions and normals are 3 floats per vertex, coordinates are 2, and
// indices are three u32 per triangle. Throws UserError when the file cannot be read.
std::vector<std::byte> mesh_attribute(const DataSource& source);

}  // namespace glint::pipeline
