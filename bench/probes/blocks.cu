// Times launches of many blocks, with and without clusters of one block, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 blocks.cu -o blocks && ncu --clock-control none --csv --page raw --print-units base \
//     --metrics sm__cycles_elapsed.max,launch__grid_size,launch__block_size ./blocks
// blocks_h100.csv and blocks_h200.csv have the kernel, its wait and these three numbers of each row that Nsight Compute printed.
// The template's arguments are the cycles that each block waits, and whether the launch has clusters of one block, as nvcc's __block_size__ makes
// them. A wait of 0 is an empty kernel.
#include <cstdio>
#include <cstdlib>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ __forceinline__ void hold(int wait) {
  if (wait == 0) return;
  const long long until = clock64() + wait;
  while (clock64() < until) {}
}
template <int WAIT> __global__ void blocks() { hold(WAIT); }
template <int WAIT> __global__ void __cluster_dims__(1, 1, 1) clusters() { hold(WAIT); }
template <int WAIT> __global__ void __cluster_dims__(2, 1, 1) pairs() { hold(WAIT); }
template <int WAIT> void all() {
  for (int threads : {32, 128, 256, 512, 1024})
    for (int count : {132, 1056, 4224, 16896}) {
      if (WAIT > 1000 && count > 4224) continue;
      blocks<WAIT><<<count, threads>>>();
      clusters<WAIT><<<count, threads>>>();
      pairs<WAIT><<<count, threads>>>();
      CHECK(cudaDeviceSynchronize());
    }
}
int main() { all<0>(); all<500>(); all<4000>(); }
