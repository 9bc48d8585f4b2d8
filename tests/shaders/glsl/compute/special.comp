// Uses specialisation constants: sizes of blocks and arrays, operations on constants, values from outside.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 4, local_size_x_id = 0, local_size_y = 2) in;
layout(constant_id = 0) const uint kWidth = 4;
layout(constant_id = 1) const int kCount = 3;
layout(constant_id = 2) const bool kDouble = false;
layout(constant_id = 3) const float kScale = 0.5;
const int kMore = kCount * 2 + (kDouble ? 10 : 0);
layout(set = 0, binding = 0) buffer Results { uint results[]; };
shared uint numbers[kCount + 1];

void main() {
  const uint id = gl_LocalInvocationIndex;
  float values[kMore];
  for (int i = 0; i < kMore; ++i) values[i] = float(i) * kScale;
  if (id <= kCount) numbers[id] = id * 10;
  barrier();
  results[id * 4] = gl_WorkGroupSize.x * 100 + gl_WorkGroupSize.y;
  results[id * 4 + 1] = uint(kMore);
  results[id * 4 + 2] = floatBitsToUint(values[id % kMore]);
  results[id * 4 + 3] = numbers[kCount];
}
