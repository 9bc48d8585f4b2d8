// Sums the 256 numbers of each block in shared memory, and writes one result per block.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = 1) writeonly buffer Sums { uint sums[]; };
shared uint partial[256];

void main() {
  const uint i = gl_LocalInvocationID.x;
  partial[i] = numbers[gl_GlobalInvocationID.x];
  barrier();
  for (uint step = 128; step > 0; step /= 2) {
    if (i < step) partial[i] += partial[i + step];
    barrier();
  }
  if (i == 0) sums[gl_WorkGroupID.x] = partial[0];
}
