// Training of a network, first kernel: 16 inputs of a block times their weights, summed for each hidden unit.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) readonly buffer Inputs { float inputs[]; };    // from 1 on
layout(set = 0, binding = 1) readonly buffer Weights { float weights[]; };  // by input, then by hidden unit
layout(set = 0, binding = 2) writeonly buffer Sums { float sums[]; };       // by block, then by hidden unit
layout(push_constant) uniform Constants { uint hidden; };
shared float values[16], products[16][16];

void main() {
  const uint unit = gl_LocalInvocationID.x, i = gl_LocalInvocationID.y, input_ = gl_WorkGroupID.x * 16 + i + 1;
  if (unit == 0) values[i] = inputs[input_];
  barrier();
  products[i][unit] = weights[input_ * (hidden + 1) + unit + 1] * values[i];
  barrier();
  for (uint reach = 1; reach < 16; reach *= 2) {
    if (i % (2 * reach) == 0) products[i][unit] += products[i + reach][unit];
    barrier();
  }
  if (i == 0) sums[gl_WorkGroupID.x * hidden + unit] = products[0][unit];
}
