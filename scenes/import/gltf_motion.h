// Moves the scene of a glTF file as one of its animations does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "scenes/import/gltf_deformer.h"
#include "scenes/motion.h"

namespace tinygltf {
class Model;
}

namespace glint::scenes {

// Returns a node's matrix in the form of instances.
Affine affine_of(const glm::dmat4& matrix);

// Places a camera as a node with this matrix has it: it looks along -z, and y is upwards.
void stand_at(Camera& camera, const glm::dmat4& matrix);

// Says which parts of a loaded scene follow which node of the file.
struct GltfMoving {
  struct Deformed {
    uint32_t model = 0;
    int node = 0;
    GltfDeformer deformer;
  };
  std::vector<int> instance_nodes;  // of each instance of the scene; -1: it stands
  std::vector<Deformed> deformed;
  int camera_node = -1, lamp_node = -1;  // -1: there is none
  uint32_t lamp_model = 0;               // with a lamp
};

// Returns what an animation (GltfAnimation) moves in the file's scene number `scene`. Throws UserError at the
// file where the animation or a skin is wrong.
std::shared_ptr<const Motion> gltf_motion(const tinygltf::Model& file, const std::string& path, int scene,
                                          const std::string& animation, GltfMoving moving);

}  // namespace glint::scenes
