// Clustering, second kernel: finds the nearest centre of every point.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer ByFeature { float by_feature[]; };
layout(set = 0, binding = 1) readonly buffer Centres { float centres[]; };
layout(set = 0, binding = 2) writeonly buffer Membership { int membership[]; };
layout(push_constant) uniform Constants { uint points, features, clusters; };

void main() {
  const uint point = gl_GlobalInvocationID.x;
  if (point >= points) return;
  int nearest = -1;
  float least = 3.4e38;
  for (uint cluster = 0; cluster < clusters; ++cluster) {
    float sum = 0;
    for (uint i = 0; i < features; ++i) {
      const float difference = by_feature[i * points + point] - centres[cluster * features + i];
      sum += difference * difference;
    }
    if (sum < least) least = sum, nearest = int(cluster);
  }
  membership[point] = nearest;
}
