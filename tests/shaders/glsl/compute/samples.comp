// Uses images of several samples: each sample is separate, sizes and counts are told, and missing samples do not exist.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 2, local_size_y = 2) in;
layout(set = 0, binding = 0) buffer Results { uint results[]; };
layout(set = 0, binding = 1, r32ui) uniform uimage2DMS image;
layout(set = 0, binding = 2, r32ui) uniform uimage2DMSArray layers;
layout(set = 0, binding = 3) uniform utexture2DMS fetched;

void main() {
  const ivec2 at = ivec2(gl_LocalInvocationID.xy);
  const uint lane = gl_LocalInvocationIndex;
  for (int s = -3; s < 7; ++s) imageStore(image, at, s, uvec4(lane * 100u + uint(s)));
  for (int s = 0; s < 4; ++s) results[lane * 16 + s] = imageLoad(image, at, s).x;
  imageAtomicAdd(image, at, 2, 5u);
  results[lane * 16 + 4] = imageLoad(image, at, 2).x;
  results[lane * 16 + 5] = uint(imageSamples(image));
  results[lane * 16 + 6] = uint(imageSize(image).x * 10 + imageSize(image).y);
  results[lane * 16 + 7] = uint(imageSamples(layers) * 100 + imageSize(layers).z);
  imageStore(layers, ivec3(at, 2), 1, uvec4(lane + 40u));
  results[lane * 16 + 8] = imageLoad(layers, ivec3(at, 2), 1).x;
  results[lane * 16 + 9] = texelFetch(fetched, at, 1).x * 1000u + texelFetch(fetched, at, 0).x;
  results[lane * 16 + 10] = uint(textureSize(fetched).x * 10 + textureSamples(fetched));
}
