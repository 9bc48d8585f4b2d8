// Kernels with sums in registers and a tile of shared memory that each turn loads anew, for the listings of an assembler.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -cubin tiles.cu && cuobjdump -sass -res-usage tiles.cubin
// tiles_S_L has S sums and L loads a turn. tiles.csv has the registers of a thread and the order of loads from global memory (L) and stores to
// shared memory (S) of a turn: how many loads are under way when a store waits for the first of them.
template <int SUMS, int LOADS> __device__ __forceinline__ void turn(const float* a, float* c, int n) {
  __shared__ float tile[LOADS][256];
  float sum[SUMS] = {};
  const int t = threadIdx.x;
  for (int k0 = 0; k0 < n; k0 += 16) {
#pragma unroll
    for (int j = 0; j < LOADS; ++j) {
      const int i = t + 256 * j;
      tile[j][(i * 7) & 255] = a[(blockIdx.x * 64 + (i >> 4)) * n + k0 + (i & 15)];
    }
    __syncthreads();
#pragma unroll
    for (int k = 0; k < LOADS; ++k) {
      const float x = tile[k][t & 15];
#pragma unroll
      for (int j = 0; j < SUMS; ++j) sum[j] += x * tile[k][(t >> 4) + j];
    }
    __syncthreads();
  }
#pragma unroll
  for (int j = 0; j < SUMS; ++j) c[(blockIdx.x * SUMS + j) * 256 + t] = sum[j];
}
#define TILES(SUMS, LOADS) \
  extern "C" __global__ void tiles_##SUMS##_##LOADS(const float* a, float* c, int n) { turn<SUMS, LOADS>(a, c, n); }
#define EACH(SUMS) TILES(SUMS, 4) TILES(SUMS, 8) TILES(SUMS, 16)
EACH(4) EACH(8) EACH(12) EACH(16) EACH(20) EACH(24) EACH(32) EACH(40) EACH(48) EACH(64)
