// Reads images of all geometries: levels, gradients, offsets, gathers, fetches, sizes, separate samplers, arrays by number.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Results { float results[]; };
layout(set = 0, binding = 1) uniform sampler2D flat_image;        // 4 x 4, three levels
layout(set = 0, binding = 2) uniform sampler2DArray layers;       // 2 x 2, three layers
layout(set = 0, binding = 3) uniform sampler3D volume;            // 2 x 2 x 2
layout(set = 0, binding = 4) uniform samplerCube cube;            // 1 x 1 faces
layout(set = 0, binding = 5) uniform usampler2D numbers[];        // two of 1 x 1
layout(set = 0, binding = 6) uniform texture2D bare;
layout(set = 0, binding = 7) uniform sampler filters[2];          // nearest, linear
layout(set = 0, binding = 8) uniform samplerBuffer texels;
layout(set = 0, binding = 9, r32f) uniform image3D volume_out;
layout(set = 0, binding = 10, rgba32f) uniform image2DArray layers_out;
layout(set = 0, binding = 11, r32i) uniform iimageBuffer line_out;
layout(set = 0, binding = 12) uniform sampler1D strip;
layout(set = 0, binding = 13) uniform sampler2DShadow shadow;
layout(set = 0, binding = 14, r32f) uniform imageCube cube_out;

void main() {
  const int id = int(gl_LocalInvocationID.x);
  const uint base = gl_LocalInvocationID.x * 32;
  const ivec2 at = ivec2(id & 3, id >> 2 & 3);
  const vec2 uv = (vec2(at) + 0.5) / 4.0;
  results[base] = texture(flat_image, uv).x;
  results[base + 1] = textureLod(flat_image, uv, 1.0).x;
  results[base + 2] = textureGrad(flat_image, uv, vec2(1.0, 0.0), vec2(0.0, 1.0)).x;
  results[base + 3] = textureLodOffset(flat_image, uv, 0.0, ivec2(1, -1)).x;
  results[base + 4] = texelFetch(flat_image, at >> 1, 1).x + texelFetchOffset(flat_image, at & 1, 0, ivec2(2, 1)).x;
  const vec4 four = textureGather(flat_image, (vec2(at & 1) + 1.0) / 4.0);
  results[base + 5] = four.x + 100.0 * four.y + 10000.0 * four.z + 0.01 * four.w;
  results[base + 6] = textureLod(layers, vec3(0.25, 0.75, float(id % 3) + 0.3), 0.0).x;
  results[base + 7] = textureLod(volume, (vec3(id & 1, id >> 1 & 1, id >> 2 & 1) + 0.5) / 2.0, 0.0).x;
  const vec3 axis = vec3(id % 3 == 0, id % 3 == 1, id % 3 == 2);
  results[base + 8] = textureLod(cube, (id & 8) == 0 ? axis : -axis, 0.0).x;
  results[base + 9] = float(texture(numbers[nonuniformEXT(id & 1)], vec2(0.5)).x);
  results[base + 10] = textureLod(sampler2D(bare, filters[nonuniformEXT(id & 1)]), vec2(0.5, 0.5), 0.0).x;
  results[base + 11] = texelFetch(bare, ivec2(1, 0), 0).x;
  results[base + 12] = texelFetch(texels, id).x;
  results[base + 13] = textureLod(strip, 0.75, 0.0).x;
  results[base + 14] = textureLod(shadow, vec3(0.25, 0.25, float(id) / 32.0), 0.0);
  const ivec2 flat_size = textureSize(flat_image, 1);
  results[base + 15] = float(flat_size.x + 10 * flat_size.y + 100 * textureQueryLevels(flat_image));
  results[base + 16] = float(textureSize(layers, 0).z + 10 * textureSize(volume, 0).z + 100 * textureSize(texels) + 10000 * textureSize(cube, 0).y);
  results[base + 17] = float(imageSize(layers_out).z + 10 * imageSize(volume_out).y + 100 * imageSize(line_out) + 10000 * imageSize(cube_out).x);
  results[base + 18] = float(textureSize(bare, 0).x);
  const ivec3 cell = ivec3(id & 1, id >> 1 & 1, id >> 2 & 1);
  if (id < 8) imageStore(volume_out, cell, vec4(imageLoad(volume_out, cell).x + float(id)));
  if (id < 3) imageStore(layers_out, ivec3(1, 0, id), vec4(id, 2, 3, 4));
  imageStore(line_out, id, ivec4(-id));
  if (id < 6) imageStore(cube_out, ivec3(0, 0, id), vec4(10 + id));
}
