// Gives the pane the colour of its instance.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT vec3 color;

void main() {
  const vec3 tints[3] = vec3[](vec3(0.9, 0.7, 0.2), vec3(0.2, 0.7, 0.6), vec3(0.7, 0.3, 0.7));
  color = tints[gl_InstanceCustomIndexEXT] / (0.4 + 0.25 * gl_HitTEXT);
}
