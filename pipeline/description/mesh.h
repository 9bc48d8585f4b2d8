// Triangle meshes from files, for geometries and for the buffers that shaders read beside them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/description/description.h"
#include "scenes/scene.h"

namespace glint::pipeline {

// OBJ or glTF (.gltf, .glb; all of its scene in world coordinates). UserError when it cannot be read.
scenes::Model load_mesh(const std::string& path, const SourceLocation& where);

// positions: 3 floats a vertex; normals: 3; coordinates: 2; indices: u32, three a triangle.
std::vector<std::byte> mesh_attribute(const DataSource& source, Diagnostics& errors);

}  // namespace glint::pipeline
