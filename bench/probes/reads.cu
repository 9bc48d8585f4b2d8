// Times reads of all cores, or of some, from the L2, at hashed lines of arrays of 64 KB to 16 MB, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 reads.cu -o reads && ./reads
// The cycles of 12 turns are those of 16 less those of 4. A core merges reads of one line that are on their way
// together, so that arrays below 4 MB seem quicker than they are.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ __forceinline__ unsigned hash(unsigned x) { x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; return x ^ x >> 16; }
// A warp reads eight times without waiting. MODE 0: `share` lanes of a line, each a sector of its own; 1: a whole line, a word a lane; 2: four whole lines, 16 bytes a lane.
template <int MODE> __global__ void reads(const unsigned* p, unsigned mask, int share, int n, unsigned salt, long long* begin, long long* end, unsigned* out) {
  const unsigned lane = threadIdx.x & 31, warp = (blockIdx.x * blockDim.x + threadIdx.x) >> 5;
  __syncthreads();
  const long long t0 = clock64();
  unsigned v = 0;
  for (int k = 0; k < n; ++k) {
    unsigned r[8];
#pragma unroll
    for (int j = 0; j < 8; ++j) {
      const unsigned id = (warp * 64 + k) * 8 + j + salt;
      if (MODE == 0) { const unsigned at = (hash(id * 32 + lane / share) & mask & ~31u) | lane % share * 8; asm volatile("ld.global.cg.u32 %0, [%1];" : "=r"(r[j]) : "l"(p + at)); }
      if (MODE == 1) { const unsigned at = (hash(id) & mask & ~31u) | lane; asm volatile("ld.global.cg.u32 %0, [%1];" : "=r"(r[j]) : "l"(p + at)); }
      if (MODE == 2) { const unsigned at = (hash(id) & mask & ~127u) | lane * 4; unsigned a, b, c, d; asm volatile("ld.global.cg.v4.u32 {%0, %1, %2, %3}, [%4];" : "=r"(a), "=r"(b), "=r"(c), "=r"(d) : "l"(p + at)); r[j] = a + b + c + d; }
    }
#pragma unroll
    for (int j = 0; j < 8; ++j) v += r[j];
  }
  if (v == 12345) out[0] = v;
  __syncthreads();
  if (threadIdx.x == 0) begin[blockIdx.x] = t0, end[blockIdx.x] = clock64();
}
int main() {
  unsigned *p, *out; long long* tb; CHECK(cudaMalloc(&p, 64 << 20)); CHECK(cudaMalloc(&out, 4096)); CHECK(cudaMalloc(&tb, 1 << 20)); CHECK(cudaMemset(p, 0, 64 << 20));
  std::vector<long long> h(4096);
  FILE* f = fopen("reads.csv", "w"); fputs("mode,lanes a line,KB,blocks,warps,turns,cycles of the slowest block,mean cycles of a block\n", f);
  for (int config = 0; config < 5; ++config) for (int kb : {64, 256, 1024, 4096, 16384}) for (int blocks : {16, 66, 132}) for (int threads : {512, 1024}) for (int n : {4, 16}) {
    const int share = (const int[]){1, 2, 4, 32, 8}[config];
    long long best = 1ll << 60, mean = 0;
    for (int r = 0; r < 5; ++r) {
      const unsigned mask = (unsigned(kb) << 8) - 1, salt = 0;  // the same places again: what can be kept near is near
      if (config < 3) reads<0><<<blocks, threads>>>(p, mask, share, n, salt, tb, tb + 2048, out);
      if (config == 3) reads<1><<<blocks, threads>>>(p, mask, share, n, salt, tb, tb + 2048, out);
      if (config == 4) reads<2><<<blocks, threads>>>(p, mask, share, n, salt, tb, tb + 2048, out);
      CHECK(cudaMemcpy(h.data(), tb, 4096 * 8, cudaMemcpyDeviceToHost));
      long long most = 0, sum = 0; for (int b = 0; b < blocks; ++b) most = std::max(most, h[2048 + b] - h[b]), sum += h[2048 + b] - h[b];
      if (most < best) best = most, mean = sum / blocks;
    }
    fprintf(f, "%s,%d,%d,%d,%d,%d,%lld,%lld\n", config < 3 ? "sectors" : config == 3 ? "line" : "four lines", share, kb, blocks, threads / 32, n, best, mean);
  }
  fclose(f);
}
