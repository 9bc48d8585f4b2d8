// Makes one mistake per compilation: WRONG stands on line 21.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_ray_query : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 32) in;
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Word { uint value; };
layout(set = 0, binding = 0) buffer Results { uint result[]; };
layout(set = 0, binding = 1) buffer Data { uint data[]; };
layout(set = 0, binding = 2) buffer Element { uint data[]; } elements[];
layout(set = 0, binding = 3, r32ui) uniform uimage2D picture;
layout(set = 0, binding = 4) uniform usampler2D sampled;
layout(push_constant) uniform Addresses { uint64_t data_address; };
shared uint words[16];
void main() {
  const uint i = gl_GlobalInvocationID.x;
  words[i % 16u] = i % 16u;
  barrier();
  uint got = 7u; WRONG
  result[i] = got;
}
