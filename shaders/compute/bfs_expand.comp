// Breadth-first search, first kernel: every node of the frontier gives its neighbours a distance.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer First { uint first_edge[]; };  // by node, and one more
layout(set = 0, binding = 1) readonly buffer Edges { uint edges[]; };
layout(set = 0, binding = 2) buffer Frontier { uint frontier[]; };
layout(set = 0, binding = 3) buffer Next { uint next[]; };
layout(set = 0, binding = 4) readonly buffer Visited { uint visited[]; };
layout(set = 0, binding = 5) buffer Distance { int distance_of[]; };
layout(push_constant) uniform Constants { uint nodes; };

void main() {
  const uint node = gl_GlobalInvocationID.x;
  if (node >= nodes || frontier[node] == 0) return;
  frontier[node] = 0;
  const uint end = first_edge[node + 1];
  for (uint i = first_edge[node]; i < end; ++i) {
    const uint to = edges[i];
    if (visited[to] != 0) continue;
    distance_of[to] = distance_of[node] + 1;  // Nodes of one frontier write the same number.
    next[to] = 1;
  }
}
