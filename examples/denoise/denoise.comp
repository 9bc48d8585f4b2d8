// Gives each pixel the mean of its neighbours.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D noisy;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D picture;
layout(push_constant) uniform Constants { int reach; };

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy), last = imageSize(noisy) - 1;
  vec3 sum = vec3(0.0);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) sum += imageLoad(noisy, clamp(at + ivec2(x, y), ivec2(0), last)).rgb;
  imageStore(picture, at, vec4(sum / float((2 * reach + 1) * (2 * reach + 1)), 1.0));
}
