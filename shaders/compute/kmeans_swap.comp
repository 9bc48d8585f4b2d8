// Clustering, first kernel: turns features by point into points by feature, so that neighbours read neighbours.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer ByPoint { float by_point[]; };
layout(set = 0, binding = 1) writeonly buffer ByFeature { float by_feature[]; };
layout(push_constant) uniform Constants { uint points, features, clusters; };

void main() {
  const uint point = gl_GlobalInvocationID.x;
  if (point >= points) return;
  for (uint i = 0; i < features; ++i) by_feature[i * points + point] = by_point[point * features + i];
}
