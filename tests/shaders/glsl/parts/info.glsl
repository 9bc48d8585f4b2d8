// Declares a payload of many types: nested structs, arrays, bools and matrices.
// SPDX-License-Identifier: Apache-2.0
struct Ids { uvec4 id; uint kind; bool front[2]; };
struct Info {
  bool hit;
  Ids ids;
  float bary[2];
  mat4x3 to_world;
  mat3 to_object;
  vec3 object_origin, object_direction;
  float t, tmin;
  uint flags;
};
