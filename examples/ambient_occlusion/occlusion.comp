// Computes ambient occlusion by ray queries from a compute shader, which needs no pipeline of shaders and no binding table.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D picture;
layout(set = 0, binding = 2) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Settings {
  float reach;
  uint rays;
} settings;

vec3 corner(uint i) {
  const uint v = 3 * indices[i];
  return vec3(positions[v], positions[v + 1], positions[v + 2]);
}

uint hash(uint x) {  // PCG's output function
  x = x * 747796405u + 2891336453u;
  x = ((x >> ((x >> 28) + 4)) ^ x) * 277803737u;
  return (x >> 22) ^ x;
}

void main() {
  const vec2 size = vec2(gl_NumWorkGroups.xy * gl_WorkGroupSize.xy);
  const vec2 at = (vec2(gl_GlobalInvocationID.xy) + 0.5) / size * 2.0 - 1.0;
  const vec3 eye = vec3(1.5, 2.0, 3.2), along = normalize(vec3(at.x - 0.75, -at.y - 1.0, -1.6));
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0xff, eye, 0.001, along, 100.0);
  while (rayQueryProceedEXT(query)) {}
  float light = 0.8;
  if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT) {
    const uint first = 3 * uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    const vec3 a = corner(first);
    vec3 normal = normalize(cross(corner(first + 1) - a, corner(first + 2) - a));
    if (dot(normal, along) > 0.0) normal = -normal;
    const vec3 from = eye + rayQueryGetIntersectionTEXT(query, true) * along + 0.001 * normal;
    uint state = hash(gl_GlobalInvocationID.x + 65536u * gl_GlobalInvocationID.y), open = 0;
    for (uint i = 0; i < settings.rays; ++i) {
      vec3 d;
      for (int c = 0; c < 3; ++c) {
        state = hash(state);
        d[c] = float(state >> 8) / 8388608.0 - 1.0;
      }
      d = normalize(d + 1.5 * normal);
      rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT, 0xff, from, 0.001, d, settings.reach);
      while (rayQueryProceedEXT(query)) {}
      if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) ++open;
    }
    light = float(open) / float(settings.rays);
  }
  imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(vec3(light), 1.0));
}
