// Clustering of a stream: what each point would gain or lose if a candidate became a centre.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Coordinates { float coordinates[]; };  // by dimension, then point
layout(set = 0, binding = 1) readonly buffer Weights { float weights[]; };
layout(set = 0, binding = 2) readonly buffer Costs { float costs[]; };  // of each point at its centre
layout(set = 0, binding = 3) writeonly buffer Changes { float changes[]; };
layout(push_constant) uniform Constants { uint points, dimensions, candidate; };
shared float middle[256];

void main() {
  const uint point = gl_GlobalInvocationID.x, i = gl_LocalInvocationID.x;
  if (i < dimensions) middle[i] = coordinates[i * points + candidate];
  barrier();
  if (point >= points) return;
  float square = 0;
  for (uint d = 0; d < dimensions; ++d) {
    const float away = coordinates[d * points + point] - middle[d];
    square += away * away;
  }
  changes[point] = square * weights[point] - costs[point];
}
