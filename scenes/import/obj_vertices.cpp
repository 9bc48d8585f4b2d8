// Makes a model of an OBJ mesh: equal corners become one vertex.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/obj_vertices.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/parallel_ranges.h"
#include "scenes/import/number_table.h"

namespace glint::scenes {
namespace {

// Hashes what makes two corners the same vertex: the values, not the file's indices.
uint32_t hash_of(const Vertex& v) {
  uint64_t state = uint64_t(uint32_t(v.material)) + 0x9e3779b97f4a7c15;
  const auto mix = [&state](float value) {
    // The sum turns -0 into +0, because the two zeros are equal and must hash alike.
    state = (state ^ std::bit_cast<uint32_t>(value + 0.0f)) * 0xff51afd7ed558ccd;
    state ^= state >> 32;
  };
  for (size_t i = 0; i < 3; ++i) mix(v.position[i]);
  for (size_t i = 0; i < 3; ++i) mix(v.normal[i]);
  for (size_t i = 0; i < 2; ++i) mix(v.texture_coordinate[i]);
  return uint32_t(state);
}

Vertex vertex_of(const ObjMesh& mesh, const ObjCorner& corner) {
  Vertex vertex;
  vertex.position = mesh.positions[size_t(corner.position)];
  if (corner.normal >= 0) vertex.normal = mesh.normals[size_t(corner.normal)];
  if (corner.coordinate >= 0) {
    const Vec2& coordinate = mesh.coordinates[size_t(corner.coordinate)];
    vertex.texture_coordinate = {coordinate[0], 1 - coordinate[1]};
  }
  vertex.material = corner.material;
  return vertex;
}

// Gives NumberTable the vertices with their hashes.
struct HashedVertices {
  const std::vector<Vertex>& vertices;
  const std::vector<uint32_t>& hashes;
  uint32_t hash(uint32_t number) const { return hashes[number]; }
  bool same(uint32_t one, uint32_t other) const {
    const Vertex &a = vertices[one], &b = vertices[other];
    return hashes[one] == hashes[other] && a.position == b.position && a.normal == b.normal &&
           a.texture_coordinate == b.texture_coordinate && a.material == b.material;
  }
};

// Returns, for each vertex, the number of the first one that is equal to it. Each thread finds the equal ones
// among vertices whose hashes lie in a range of its own.
std::vector<uint32_t> firsts_of(const std::vector<Vertex>& vertices, const std::vector<uint32_t>& hashes,
                                uint32_t threads) {
  std::vector<uint32_t> first(vertices.size());
  const uint64_t ranges = std::max(threads, 1u);
  parallel_ranges(ranges, 1, threads, [&](size_t range, size_t) {
    NumberTable<HashedVertices> table({vertices, hashes});
    for (uint32_t i = 0; i < vertices.size(); ++i)
      if (hashes[i] * ranges >> 32 == range) first[i] = table.first_of(i);
  });
  return first;
}

// Moves the vertices that are the first of their kind together, and makes of `first` where each one's kind
// is.
void compact(std::vector<Vertex>& vertices, std::vector<uint32_t>& first) {
  uint32_t kept = 0;
  for (uint32_t i = 0; i < vertices.size(); ++i)
    if (first[i] == i) {
      vertices[kept] = vertices[i];
      first[i] = kept++;
    } else
      first[i] = first[first[i]];
  vertices.resize(kept);
}

}  // namespace

Model model_of(ObjMesh mesh, uint32_t threads) {
  std::vector<size_t> corners_above, indices_above;
  size_t corners = 0, indices = 0;
  for (const ObjFaces& faces : mesh.faces) {
    corners_above.push_back(corners), corners += faces.corners.size();
    indices_above.push_back(indices), indices += faces.triangles.size();
  }
  Model model;
  model.vertices.resize(corners);
  std::vector<uint32_t> hashes(corners);
  parallel_ranges(mesh.faces.size(), 1, threads, [&](size_t i, size_t) {
    size_t at = corners_above[i];
    for (const ObjCorner& corner : std::exchange(mesh.faces[i].corners, {})) {
      model.vertices[at] = vertex_of(mesh, corner);
      hashes[at] = hash_of(model.vertices[at]);
      ++at;
    }
  });
  mesh.positions = {}, mesh.normals = {}, mesh.coordinates = {};
  std::vector<uint32_t> vertex = firsts_of(model.vertices, hashes, threads);
  compact(model.vertices, vertex);
  model.indices.resize(indices);
  parallel_ranges(mesh.faces.size(), 1, threads, [&](size_t i, size_t) {
    size_t at = indices_above[i];
    for (const uint32_t corner : std::exchange(mesh.faces[i].triangles, {}))
      model.indices[at++] = vertex[corners_above[i] + corner];
  });
  return model;
}

}  // namespace glint::scenes
