// Ranges in a B+ tree: a block finds the last key up to either end of its range, which gives first and count.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Keys { int keys[]; };
layout(set = 0, binding = 1) readonly buffer Below { uint below[]; };
layout(set = 0, binding = 2) readonly buffer Ranges { ivec2 ranges[]; };   // before the first key, the last key
layout(set = 0, binding = 3) writeonly buffer Found { uvec2 found[]; };   // first record and their number
layout(push_constant) uniform Constants { uint root, height; };
shared uint low, high;

void main() {
  const uint i = gl_LocalInvocationID.x;
  const ivec2 range = ranges[gl_WorkGroupID.x];
  if (i == 0) low = high = root;
  barrier();
  for (uint level = 0; level < height; ++level) {
    const uint low_at = low * 256 + i, high_at = high * 256 + i;
    barrier();
    if (keys[low_at] <= range.x && (i == 255 || range.x < keys[low_at + 1])) low = below[low_at];
    if (keys[high_at] <= range.y && (i == 255 || range.y < keys[high_at + 1])) high = below[high_at];
    barrier();
  }
  if (i == 0) found[gl_WorkGroupID.x] = uvec2(low + 1, high - low);
}
