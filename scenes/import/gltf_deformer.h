// Deforms a mesh of a glTF file by morph targets and a skin.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenes/import/gltf_mesh.h"
#include "scenes/scene.h"

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace glint::scenes {

struct GltfPlace;

// Returns whether a node's mesh is deformed: by the node's skin, or by morph targets of the mesh.
bool is_deformed(const tinygltf::Model& file, int node);

// Holds what deforms the model of one node.
class GltfDeformer {
 public:
  // `rest` is the mesh of the node as read_mesh() returns it with its origins. Throws UserError at the file
  // for numbers that name nothing and for attributes that do not fit the vertices.
  GltfDeformer(const tinygltf::Model& file, const std::string& path, int node,
               const std::vector<PrimitiveOrigin>& origins, const Model& rest);

  // Returns the joints of the skin, as nodes; none without a skin. A skinned model lies in the world.
  const std::vector<int>& joints() const { return joints_; }
  // Returns whether morph targets change it.
  bool has_targets() const { return !targets_.empty(); }
  // Sets places and normals of the model's vertices (glTF 2.0, 3.7.2.2 and 3.7.3.3): the targets are added
  // with their weights, and the result follows the matrices of the joints. `worlds` holds the matrix of each
  // node, and `weights` those of the targets; where it is empty, the mesh's own count.
  void deform(Model& model, std::span<const glm::dmat4> worlds, std::span<const double> weights) const;

 private:
  struct Influence {
    uint32_t joint = 0;  // index into joints_
    float weight = 0;
  };
  struct Target {
    std::vector<Vec3> places, normals;  // by vertex of the model; what is added
  };
  void add_influences(const GltfPlace& place, const tinygltf::Primitive& primitive,
                      const PrimitiveOrigin& origin);
  void add_targets(const GltfPlace& place, const tinygltf::Primitive& primitive,
                   const PrimitiveOrigin& origin, size_t vertices);
  void skin(Model& model, std::span<const glm::dmat4> worlds) const;

  std::vector<Vertex> rest_;
  std::vector<int> joints_;
  std::vector<glm::dmat4> inverse_bind_;            // of each joint
  std::vector<std::vector<Influence>> influences_;  // of each vertex; their weights sum up to 1
  std::vector<Target> targets_;
  std::vector<double> weights_;  // those that the mesh gives the targets
  std::vector<std::pair<uint32_t, uint32_t>>
      flat_;  // first vertex and count, where triangles have flat normals
};

}  // namespace glint::scenes
