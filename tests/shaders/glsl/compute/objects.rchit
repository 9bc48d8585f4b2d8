// Reads both forms of one built-in matrix, of which glslang makes two variables with one decoration.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT vec4 color;
void main() {
  color = vec4(gl_ObjectToWorldEXT * vec4(1.0, 2.0, 3.0, 1.0), (vec4(1.0, 2.0, 3.0, 1.0) * gl_ObjectToWorld3x4EXT).x);
}
