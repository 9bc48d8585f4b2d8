// Smooths what has been accumulated, across no edge, and less where many frames were mixed.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D history[2];
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D picture;
layout(push_constant) uniform Constants { uint frame; int reach; };

const float kSameSurface = 0.05;  // part of the distance by which neighbours on one surface may differ

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), last = imageSize(picture) - 1;
  const vec3 here = imageLoad(history[frame & 1u], pixel).rgb;
  const float width = 2.0 * float(reach) / sqrt(here.b);
  float sum = 0.0, weights = 0.0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const vec3 there = imageLoad(history[frame & 1u], clamp(pixel + ivec2(x, y), ivec2(0), last)).rgb;
      if (abs(there.g - here.g) > kSameSurface * abs(here.g)) continue;
      const float weight = exp(-float(x * x + y * y) / (width * width)) * there.b;
      sum += weight * there.r;
      weights += weight;
    }
  imageStore(picture, pixel, vec4(vec3(weights > 0.0 ? sum / weights : here.r), 1.0));
}
