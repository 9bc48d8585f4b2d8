// Training of a network, second kernel: adjusts the weights by the errors of the hidden units.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) readonly buffer Inputs { float inputs[]; };
layout(set = 0, binding = 1) buffer Weights { float weights[]; };
layout(set = 0, binding = 2) buffer Changes { float changes[]; };  // of the round before
layout(set = 0, binding = 3) readonly buffer Errors { float errors[]; };
layout(push_constant) uniform Constants { uint hidden; };

void main() {
  const uint unit = gl_LocalInvocationID.x + 1, input_ = gl_WorkGroupID.x * 16 + gl_LocalInvocationID.y + 1;
  const uint index = input_ * (hidden + 1) + unit;
  const float change = 0.3 * errors[unit] * inputs[input_] + 0.3 * changes[index];
  weights[index] += change;
  changes[index] = change;
  if (input_ != 1) return;
  const float bias = 0.3 * errors[unit] + 0.3 * changes[unit];  // input 0 is always 1
  weights[unit] += bias;
  changes[unit] = bias;
}
