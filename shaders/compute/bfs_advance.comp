// Breadth-first search, second kernel: the nodes that were found become the frontier.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) buffer Frontier { uint frontier[]; };
layout(set = 0, binding = 1) buffer Next { uint next[]; };
layout(set = 0, binding = 2) buffer Visited { uint visited[]; };
layout(set = 0, binding = 3) buffer More { uint more; };
layout(push_constant) uniform Constants { uint nodes; };

void main() {
  const uint node = gl_GlobalInvocationID.x;
  if (node >= nodes || next[node] == 0) return;
  frontier[node] = 1;
  visited[node] = 1;
  next[node] = 0;
  more = 1;
}
