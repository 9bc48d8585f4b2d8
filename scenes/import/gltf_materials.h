// Materials and textures of a glTF file as LumiBench's few models know them.
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

// Appends the file's materials to the scene, and one grey 0.7 for primitives without any; returns their
// indices there. Sets Scene::alpha_test where one is masked. Base-colour textures keep their sRGB and
// wrapping; what a mask hides has alpha 0, all else 255. std::out_of_range: an index names nothing.
std::vector<int32_t> add_gltf_materials(Scene& scene, const tinygltf::Model& file);

}  // namespace glint::scenes
