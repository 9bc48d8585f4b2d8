// Reads materials and textures of a glTF file as LumiBench's few models know them.
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

// Appends the file's materials to the scene, and one of grey 0.7 for primitives without a material. Returns
// their indices in the scene. Sets Scene::alpha_test when a material is masked. Base-colour textures keep
// their sRGB flag and wrapping; texels that a mask hides have alpha 0, and all others have 255. Throws
// UserError at `path` when a number names nothing or a texture has no picture.
std::vector<int32_t> add_gltf_materials(Scene& scene, const tinygltf::Model& file, const std::string& path);

}  // namespace glint::scenes
