// Triangles of glTF files, where the library that reads them was there when Glint was built.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "base/diagnostics.h"
#include "scenes/scene.h"

namespace glint::pipeline {

// Every triangle primitive of every node of the default scene, nodes' transforms applied; materials are not read.
// UserError: not readable, primitives other than triangles, positions that are not float.
scenes::Model load_gltf(const std::string& path, const SourceLocation& where);

}  // namespace glint::pipeline
