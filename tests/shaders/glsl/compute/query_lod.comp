// Queries the level that an implicit sample would read: one texel apart to the right, several down.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_NV_compute_shader_derivatives : require
layout(local_size_x = 8, local_size_y = 4) in;
layout(derivative_group_quadsNV) in;
layout(binding = 0) buffer Out { vec2 levels[]; };
layout(binding = 1) uniform sampler2D picture;  // 4 x 4 texels, three levels
void main() {
  const float texels[4] = float[](0.5, 1.0, 2.0, 64.0);  // by pairs of rows and of columns
  uint i = (gl_LocalInvocationID.y / 2u) * 2u + gl_LocalInvocationID.x / 4u;
  vec2 place = vec2(gl_LocalInvocationID.xy % 2u) * vec2(texels[i] / 4.0, texels[i] / 8.0);
  levels[gl_LocalInvocationIndex] = textureQueryLod(picture, place);
}
