// Declares bindings 4 to 9: vertices, indices, materials, where each model starts, textures and spheres.
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_GEOMETRY_GLSL
#define GLINT_GEOMETRY_GLSL
#include "material.glsl"

layout(set = 0, binding = 4, std430) readonly buffer Vertices { float vertex_words[]; };  // 9 per vertex
layout(set = 0, binding = 5, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 6, std430) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = 7, std430) readonly buffer Offsets { uvec2 model_offsets[]; };  // first index, first vertex
layout(set = 0, binding = 8) uniform sampler2D textures[];
layout(set = 0, binding = 9, std430) readonly buffer Spheres { vec4 spheres[]; };  // centre, radius; by model

struct Vertex {
  vec3 position;
  vec3 normal;
  vec2 texture_coordinate;
  int material;
};

const uint kVertexWords = 9u;  // 36 bytes

Vertex load_vertex(uint vertex) {
  uint word = vertex * kVertexWords;
  Vertex result;
  result.position = vec3(vertex_words[word], vertex_words[word + 1u], vertex_words[word + 2u]);
  result.normal = vec3(vertex_words[word + 3u], vertex_words[word + 4u], vertex_words[word + 5u]);
  result.texture_coordinate = vec2(vertex_words[word + 6u], vertex_words[word + 7u]);
  result.material = floatBitsToInt(vertex_words[word + 8u]);
  return result;
}

// Holds a hit triangle's corners, its interpolated attributes, and the material of its first corner.
struct Surface {
  vec3 normal;
  vec2 texture_coordinate;
  int material;
};

Surface load_surface(uint model, uint primitive, vec2 barycentrics) {
  uvec2 offsets = model_offsets[model];
  uint first = offsets.x + primitive * 3u;
  Vertex v0 = load_vertex(offsets.y + indices[first]);
  Vertex v1 = load_vertex(offsets.y + indices[first + 1u]);
  Vertex v2 = load_vertex(offsets.y + indices[first + 2u]);
  vec3 weight = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y);
  Surface surface;
  vec3 normal = v0.normal * weight.x + v1.normal * weight.y + v2.normal * weight.z;
#ifdef GLINT_INSTANCES
  normal = (normal * gl_WorldToObjectEXT).xyz;  // normals are transformed by the inverse transpose
#endif
  surface.normal = normalize(normal);
  surface.texture_coordinate = v0.texture_coordinate * weight.x + v1.texture_coordinate * weight.y +
                               v2.texture_coordinate * weight.z;
  surface.material = v0.material;
  return surface;
}

#endif
