// Reads a glTF animation and evaluates it: the pose of each node at a time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
class Node;
}  // namespace tinygltf

namespace glint::scenes {

// Holds where a node is, seen from its parent (glTF 2.0, 3.5.3).
struct NodePose {
  glm::dvec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};
  glm::dvec3 scale{1};
  std::optional<glm::dmat4> matrix{};  // instead of the three
  std::vector<double> weights{};       // of morph targets; empty: those of the node's mesh

  glm::dmat4 local() const;  // translation * rotation * scale, column-major
};

NodePose pose_of(const tinygltf::Node& node);

class GltfAnimation {
 public:
  // Reads the animation with this name or number, or the first one for "". A file without animations gives
  // one in which nothing moves. Throws UserError at the file when there is no such animation, when times do
  // not rise, and when values do not fit what they move.
  GltfAnimation(const tinygltf::Model& file, const std::string& path, const std::string& name);

  // Returns the time of the last key, in seconds; 0 when nothing moves.
  double seconds() const { return seconds_; }
  // Returns whether a node's own pose or weights move.
  bool moves(int node) const { return moves_[size_t(node)]; }
  // Brings the nodes to a time, from the poses that the file gives them. Before its first key and after its
  // last one a channel stands still.
  void pose(std::vector<NodePose>& nodes, double seconds) const;

 private:
  enum class Path : uint8_t { Translation, Rotation, Scale, Weights };
  enum class Interpolation : uint8_t { Step, Linear, CubicSpline };
  struct Channel {
    int node = 0;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    size_t components = 0;
    std::vector<float> times, values;  // a cubic spline has in-tangent, value and out-tangent for each key

    std::vector<double> at(double seconds) const;
  };
  void add_channel(const tinygltf::Model& file, const std::string& path, size_t animation, size_t channel);

  std::vector<Channel> channels_;
  std::vector<bool> moves_;  // of each node
  double seconds_ = 0;
};

}  // namespace glint::scenes
