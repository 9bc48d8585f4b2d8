// Lights the sphere from above left. The normal comes from the intersection shader.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT vec3 color;
hitAttributeEXT vec3 normal;

void main() {
  const vec3 tints[3] = vec3[](vec3(0.9, 0.3, 0.2), vec3(0.3, 0.8, 0.3), vec3(0.3, 0.4, 0.9));
  const vec3 outward = normalize(mat3(gl_ObjectToWorldEXT) * normal);  // no scaling in this scene
  color = tints[gl_PrimitiveID % 3] * (0.2 + 0.8 * max(0.0, dot(outward, normalize(vec3(-1.0, 2.0, 1.0)))));
}
