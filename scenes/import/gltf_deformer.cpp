// Deforms meshes of glTF files.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/gltf_deformer.h"

#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <tiny_gltf.h>

#include "scenes/import/gltf_accessor.h"
#include "scenes/import/gltf_names.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

constexpr int kInfluences = 4;  // of a vertex in one set of attributes

// Returns the number of the accessor of an attribute, or -1.
int attribute_of(const std::map<std::string, int>& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

// Calls put(vertex of the model, vertex of the primitive) for each vertex that came from the primitive.
template <class Put>
void for_vertices(const PrimitiveOrigin& origin, const Put& put) {
  const size_t count = origin.corners.empty() ? origin.vertices : origin.corners.size();
  for (size_t i = 0; i < count; ++i)
    put(origin.first_vertex + i, origin.corners.empty() ? i : size_t{origin.corners[i]});
}

// Returns an attribute of a primitive, which every vertex of it has.
std::vector<float> attribute(const GltfPlace& place, int accessor, int components, const std::string& name,
                             const PrimitiveOrigin& origin) {
  std::vector<float> out = floats_of(place, accessor, components, name);
  if (out.size() != size_t{origin.vertices} * size_t(components))
    place.fail("the attributes of a primitive have different counts");
  for (const float value : out)
    if (!std::isfinite(value)) place.fail(fmt::format("a value of {} is {}", name, value));
  return out;
}

Vec3 vector_at(const std::vector<float>& values, size_t i) {
  return glm::make_vec3(values.data() + 3 * i);
}

}  // namespace

bool is_deformed(const tinygltf::Model& file, int number) {
  const tinygltf::Node& node = file.nodes[size_t(number)];
  if (node.mesh < 0 || size_t(node.mesh) >= file.meshes.size()) return false;
  for (const tinygltf::Primitive& primitive : file.meshes[size_t(node.mesh)].primitives)
    if (!primitive.targets.empty()) return true;
  return node.skin >= 0;
}

GltfDeformer::GltfDeformer(const tinygltf::Model& file, const std::string& path, int number,
                           const std::vector<PrimitiveOrigin>& origins, const Model& rest)
    : rest_(rest.vertices) {
  const tinygltf::Node& node = file.nodes[size_t(number)];
  const tinygltf::Mesh& mesh = file.meshes[size_t(node.mesh)];
  const GltfPlace place{file, path, "mesh " + name_of(mesh.name, node.mesh)};
  if (node.skin >= 0) {
    const tinygltf::Skin& skin = named(file.skins, node.skin, "skin", path);
    for (const int joint : skin.joints) {
      named(file.nodes, joint, "node", path);
      joints_.push_back(joint);
    }
    inverse_bind_.resize(joints_.size(), glm::dmat4(1));
    if (skin.inverseBindMatrices >= 0) {
      const std::vector<float> matrices = floats_of(place, skin.inverseBindMatrices, 16, "a skin's matrices");
      if (matrices.size() < 16 * joints_.size()) place.fail("its skin has fewer matrices than joints");
      for (size_t i = 0; i < joints_.size(); ++i)
        inverse_bind_[i] = glm::dmat4(glm::make_mat4(matrices.data() + 16 * i));
    }
    influences_.resize(rest_.size());
  }
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    if (!joints_.empty()) add_influences(place, mesh.primitives[i], origins[i]);
    add_targets(place, mesh.primitives[i], origins[i], rest_.size());
    if (!origins[i].corners.empty())
      flat_.emplace_back(origins[i].first_vertex, uint32_t(origins[i].corners.size()));
  }
  weights_ = mesh.weights;
  weights_.resize(targets_.size());
}

void GltfDeformer::add_influences(const GltfPlace& place, const tinygltf::Primitive& primitive,
                                  const PrimitiveOrigin& origin) {
  for (int set = 0;; ++set) {
    const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
    const int joints_at = attribute_of(primitive.attributes, joints),
              weights_at = attribute_of(primitive.attributes, weights);
    if (set == 0 && (joints_at < 0 || weights_at < 0))
      place.fail("a primitive of a skinned node has no JOINTS_0 or no WEIGHTS_0");
    if (joints_at < 0 || weights_at < 0) break;
    const std::vector<float> joint = attribute(place, joints_at, kInfluences, joints, origin),
                             weight = attribute(place, weights_at, kInfluences, weights, origin);
    for_vertices(origin, [&](size_t vertex, size_t from) {
      for (size_t k = from * kInfluences; k < (from + 1) * kInfluences; ++k) {
        if (weight[k] == 0) continue;
        if (joint[k] < 0 || joint[k] >= float(joints_.size()))
          place.fail(fmt::format("a vertex names joint {} of {}", joint[k], joints_.size()));
        influences_[vertex].push_back({uint32_t(joint[k]), weight[k]});
      }
    });
  }
  for_vertices(origin, [&](size_t vertex, size_t) {
    float sum = 0;
    for (const Influence& influence : influences_[vertex]) sum += influence.weight;
    if (!influences_[vertex].empty() && !(sum > 0))
      place.fail("the weights of a vertex have no positive sum");
    for (Influence& influence : influences_[vertex]) influence.weight /= sum;
  });
}

void GltfDeformer::add_targets(const GltfPlace& place, const tinygltf::Primitive& primitive,
                               const PrimitiveOrigin& origin, size_t vertices) {
  if (primitive.targets.size() > targets_.size())
    targets_.resize(primitive.targets.size(), {std::vector<Vec3>(vertices), std::vector<Vec3>(vertices)});
  for (size_t t = 0; t < primitive.targets.size(); ++t) {
    const auto add = [&](const char* name, std::vector<Vec3>& to) {
      const int accessor = attribute_of(primitive.targets[t], name);
      if (accessor < 0) return;
      const std::vector<float> values = attribute(place, accessor, 3, name, origin);
      for_vertices(origin, [&](size_t vertex, size_t from) { to[vertex] = vector_at(values, from); });
    };
    add("POSITION", targets_[t].places);
    add("NORMAL", targets_[t].normals);
  }
}

void GltfDeformer::deform(Model& model, std::span<const glm::dmat4> worlds,
                          std::span<const double> weights) const {
  model.vertices = rest_;
  for (size_t t = 0; t < targets_.size(); ++t) {
    const auto weight = float(weights.empty() ? weights_[t] : t < weights.size() ? weights[t] : 0);
    if (weight == 0) continue;
    for (size_t i = 0; i < rest_.size(); ++i) {
      model.vertices[i].position += weight * targets_[t].places[i];
      model.vertices[i].normal += weight * targets_[t].normals[i];
    }
  }
  if (!joints_.empty()) skin(model, worlds);
  for (const auto& [first, count] : flat_)
    for (uint32_t i = first; i + 2 < first + count; i += 3) {
      Vertex* const corner = &model.vertices[i];
      const Vec3 normal =
          normalized(cross(corner[1].position - corner[0].position, corner[2].position - corner[0].position));
      for (size_t k = 0; k < 3; ++k) corner[k].normal = normal;
    }
}

void GltfDeformer::skin(Model& model, std::span<const glm::dmat4> worlds) const {
  std::vector<glm::dmat4> joints(joints_.size());
  for (size_t i = 0; i < joints_.size(); ++i) joints[i] = worlds[size_t(joints_[i])] * inverse_bind_[i];
  for (size_t i = 0; i < model.vertices.size(); ++i) {
    if (influences_[i].empty()) continue;  // No joint holds it, so it stays.
    Vertex& vertex = model.vertices[i];
    glm::dmat4 sum(0);
    for (const Influence& influence : influences_[i])
      sum += double(influence.weight) * joints[influence.joint];
    vertex.position = Vec3(sum * glm::dvec4(vertex.position, 1));
    // Normals follow the inverse transpose, which is the matrix of cofactors but for its length.
    const glm::dmat3 m(sum);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const double sign = glm::determinant(m) < 0 ? -1 : 1;
    vertex.normal = normalized(Vec3(sign * (cofactors * glm::dvec3(vertex.normal))));
  }
}

}  // namespace glint::scenes
