// Search in a B+ tree: a block follows one query down, and its threads look at all keys of a node at once.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Keys { int keys[]; };    // 256 a node, ascending
layout(set = 0, binding = 1) readonly buffer Below { uint below[]; };  // child of a key, or its record
layout(set = 0, binding = 2) readonly buffer Queries { int queries[]; };
layout(set = 0, binding = 3) readonly buffer Records { int records[]; };
layout(set = 0, binding = 4) writeonly buffer Answers { int answers[]; };  // -1: no such key
layout(push_constant) uniform Constants { uint root, height; };
shared uint node;

void main() {
  const uint i = gl_LocalInvocationID.x;
  const int query = queries[gl_WorkGroupID.x];
  if (i == 0) {
    node = root;
    answers[gl_WorkGroupID.x] = -1;
  }
  barrier();
  for (uint level = 0; level + 1 < height; ++level) {
    const uint at = node * 256 + i;
    barrier();
    if (keys[at] <= query && (i == 255 || query < keys[at + 1])) node = below[at];
    barrier();
  }
  const uint at = node * 256 + i;
  if (keys[at] == query) answers[gl_WorkGroupID.x] = records[below[at]];
}
