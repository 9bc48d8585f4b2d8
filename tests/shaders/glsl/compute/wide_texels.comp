// Uses an image of 64-bit texels: sums that carry, and the maximum of numbers that differ in their high halves.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_image_int64 : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Results { uint64_t results[]; };
layout(set = 0, binding = 1, r64ui) uniform u64image2D image;

void main() {
  const int lane = int(gl_LocalInvocationIndex);
  const uint64_t high = uint64_t(1) << 32;
  imageStore(image, ivec2(lane, 0), u64vec4(lane == 0 ? high - 1ul : (uint64_t(0x80000000u + uint(lane)) << 32) + 3ul));
  memoryBarrierImage();
  barrier();
  imageAtomicAdd(image, ivec2(0, 0), high + 1ul);
  if (lane > 0) {
    imageAtomicMax(image, ivec2(lane, 0), uint64_t(lane + 5));
    imageAtomicAdd(image, ivec2(lane, 0), uint64_t(lane + 2));
  }
  memoryBarrierImage();
  barrier();
  results[lane] = imageLoad(image, ivec2(lane, 0)).x;
}
