// Breadth-first search, first kernel: every node of the frontier gives its neighbours a distance.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((256, 1, 1))
bfs_expand(const unsigned* first_edge, const unsigned* edges, unsigned* frontier, unsigned* next,
           const unsigned* visited, int* distance_of, unsigned nodes) {
  const unsigned node = blockIdx.x * 256 + threadIdx.x;
  if (node >= nodes || frontier[node] == 0) return;
  frontier[node] = 0;
  const unsigned end = first_edge[node + 1];
  for (unsigned i = first_edge[node]; i < end; ++i) {
    const unsigned to = edges[i];
    if (visited[to] != 0) continue;
    distance_of[to] = distance_of[node] + 1;  // Nodes of one frontier write the same number.
    next[to] = 1;
  }
}
