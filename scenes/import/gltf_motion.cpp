// Moves the scenes of glTF files.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_motion.h"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <glm/mat4x3.hpp>
#include <glm/matrix.hpp>
#include <tiny_gltf.h>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/import/gltf_animation.h"
#include "scenes/import/gltf_names.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

class GltfMotion final : public Motion {
 public:
  GltfMotion(const tinygltf::Model& file, const std::string& path, int scene, const std::string& animation,
             GltfMoving moving)
      : animation_(file, path, animation), moving_(std::move(moving)), parent_(file.nodes.size(), kNone) {
    for (const tinygltf::Node& node : file.nodes) rest_.push_back(pose_of(node));
    for (const int root : file.scenes[size_t(scene)].nodes) add_below(file, root);
    for (const GltfMoving::Deformed& deformed : moving_.deformed)
      for (const int joint : deformed.deformer.joints())
        if (parent_[size_t(joint)] == kNone)
          throw UserError({path},
                          fmt::format("the skin of node {} has the joint {}, which is not in the scene",
                                      deformed.node, joint));
  }

  double seconds() const override { return animation_.seconds(); }

  std::vector<uint32_t> deformed() const override {
    std::vector<uint32_t> out;
    for (const GltfMoving::Deformed& one : moving_.deformed) {
      bool does_move = one.deformer.has_targets() && animation_.moves(one.node);
      for (const int joint : one.deformer.joints()) does_move |= follows(joint);
      if (does_move) out.push_back(one.model);
    }
    if (moving_.lamp_node >= 0 && follows(moving_.lamp_node)) out.push_back(moving_.lamp_model);
    std::sort(out.begin(), out.end());
    return out;
  }

  void pose(Scene& scene, double seconds) const override {
    std::vector<NodePose> poses = rest_;
    animation_.pose(poses, seconds);
    std::vector<glm::dmat4> worlds(poses.size(), glm::dmat4(1));
    for (const int node : order_) {
      const int parent = parent_[size_t(node)];
      worlds[size_t(node)] =
          (parent == kRoot ? glm::dmat4(1) : worlds[size_t(parent)]) * poses[size_t(node)].local();
    }
    for (size_t i = 0; i < scene.instances.size(); ++i)
      if (const int node = moving_.instance_nodes[i]; node >= 0)
        scene.instances[i].to_world = affine_of(worlds[size_t(node)]);
    for (const GltfMoving::Deformed& one : moving_.deformed)
      one.deformer.deform(scene.models[one.model], worlds, poses[size_t(one.node)].weights);
    if (moving_.camera_node >= 0) stand_at(scene.camera, worlds[size_t(moving_.camera_node)]);
    if (moving_.lamp_node >= 0) {
      scene.camera.light_position = Vec3(worlds[size_t(moving_.lamp_node)][3]);
      scene.models[moving_.lamp_model].center = scene.camera.light_position;
    }
  }

 private:
  static constexpr int kNone = -2, kRoot = -1;  // for a parent

  // Adds a node and those below it, parents first. The loader has seen that they are a tree.
  void add_below(const tinygltf::Model& file, int root) {
    parent_[size_t(root)] = kRoot;
    order_.push_back(root);
    for (size_t i = order_.size() - 1; i < order_.size(); ++i)
      for (const int child : file.nodes[size_t(order_[i])].children) {
        parent_[size_t(child)] = order_[i];
        order_.push_back(child);
      }
  }

  // Returns whether a node or one above it moves.
  bool follows(int node) const {
    for (; node >= 0; node = parent_[size_t(node)])
      if (animation_.moves(node)) return true;
    return false;
  }

  const GltfAnimation animation_;
  const GltfMoving moving_;
  std::vector<NodePose> rest_;
  std::vector<int> parent_;  // of each node; kNone: it is not in the scene
  std::vector<int> order_;   // the nodes of the scene, parents first
};

}  // namespace

Affine affine_of(const glm::dmat4& matrix) {
  return glm::transpose(glm::mat4x3(glm::mat4(matrix)));
}

void stand_at(Camera& camera, const glm::dmat4& matrix) {
  camera.eye = Vec3(matrix[3]);
  camera.target = camera.eye - normalized(Vec3(matrix[2]));
  camera.up = normalized(Vec3(matrix[1]));
}

std::shared_ptr<const Motion> gltf_motion(const tinygltf::Model& file, const std::string& path, int scene,
                                          const std::string& animation, GltfMoving moving) {
  return std::make_shared<GltfMotion>(file, path, scene, animation, std::move(moving));
}

}  // namespace glint::scenes
