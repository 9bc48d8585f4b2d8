// Looks up eight random places of a table that all blocks share.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 128) in;
layout(set = 0, binding = 0) readonly buffer Table { float table[]; };
layout(set = 0, binding = 1) buffer Sums { float sums[]; };
layout(push_constant) uniform Constants { uint entries; };
void main() {
  uint number = gl_GlobalInvocationID.x;
  float sum = 0;
  for (uint i = 0; i < 8; ++i) {
    number = number * 747796405u + 2891336453u;
    number ^= number >> 13;
    sum += table[number % entries];
  }
  sums[gl_GlobalInvocationID.x] = sum;
}
