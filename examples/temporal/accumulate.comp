// Mixes the light of a frame with what earlier frames have seen of the same points.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "camera.glsl"
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D noisy;
layout(set = 0, binding = 2, rgba32f) uniform image2D history[2];  // light, distance, number of frames; by parity
layout(push_constant) uniform Constants { uint frame; };

const float kMostFrames = 16.0;    // so that what changes is seen soon
const float kSamePlace = 0.03;     // part of the distance by which the same point may differ

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(noisy);
  const vec2 now = imageLoad(noisy, pixel).ra;
  float light = now.r, frames = 1.0;
  if (frame > 0u && now.g > 0.0) {
    // Where was this point in the frame before? It was hidden there if something else is at that pixel.
    const vec3 offset = eye_in(frame) + now.g * direction_of(pixel, size) - eye_in(frame - 1u);
    const ivec2 then = pixel_of(offset, size);
    if (all(greaterThanEqual(then, ivec2(0))) && all(lessThan(then, size))) {
      const vec3 old = imageLoad(history[(frame + 1u) & 1u], then).rgb;
      if (abs(old.g - length(offset)) < kSamePlace * length(offset)) {
        frames = min(old.b + 1.0, kMostFrames);
        light = mix(old.r, now.r, 1.0 / frames);
      }
    }
  }
  imageStore(history[frame & 1u], pixel, vec4(light, now.g, frames, 1.0));
}
