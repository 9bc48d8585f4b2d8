// Breadth-first search, second kernel: the nodes that were found become the frontier.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((256, 1, 1))
bfs_advance(unsigned* frontier, unsigned* next, unsigned* visited, unsigned* more, unsigned nodes) {
  const unsigned node = blockIdx.x * 256 + threadIdx.x;
  if (node >= nodes || next[node] == 0) return;
  frontier[node] = 1;
  visited[node] = 1;
  next[node] = 0;
  *more = 1;
}
