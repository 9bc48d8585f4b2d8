// Multiplies two matrices: each block reads rows and columns that many others read, too.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) readonly buffer Left { float left[]; };
layout(set = 0, binding = 1) readonly buffer Right { float right[]; };
layout(set = 0, binding = 2) buffer Product { float product[]; };
layout(push_constant) uniform Constants { uint columns, terms; };
void main() {
  const uint x = gl_GlobalInvocationID.x, y = gl_GlobalInvocationID.y;
  float sum = 0;
  for (uint i = 0; i < terms; ++i) sum += left[y * terms + i] * right[i * columns + x];
  product[y * columns + x] = sum;
}
