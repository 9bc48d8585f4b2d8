// Times reductions and atomics of all cores on few and on many lines of memory, on a real GPU (probes/README.md).
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 reductions.cu -o reductions && ./reductions > reductions.csv
#include <cstdio>
#include <cstdlib>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ unsigned hash(unsigned x) { x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; return x ^ x >> 16; }
// Lane l adds to word (l % lanes) of sector (l / lanes) of the warp's line; lanes * sectors lanes take part. The warp's line is one of `lines`.
template <bool RETURNS> __global__ void reds(unsigned* p, int lanes, int sectors, unsigned lines, int n, unsigned* out, int gap) {
  const unsigned lane = threadIdx.x & 31, warp = (blockIdx.x * blockDim.x + threadIdx.x) >> 5;
  if (lane >= lanes * sectors) return;
  unsigned v = 0;
  for (int k = 0; k < n; ++k) {
    const unsigned line = lines == 1 ? 0 : hash(warp * 64 + k) % lines;
    unsigned* at = p + size_t(line) * gap + (lane / lanes) * 8 + lane % lanes;
    if (RETURNS) { unsigned r; asm volatile("atom.global.add.u32 %0, [%1], %2;" : "=r"(r) : "l"(at), "r"(lane + k) : "memory"); v += r; }
    else asm volatile("red.global.add.u32 [%0], %1;" :: "l"(at), "r"(lane + k) : "memory");
  }
  if (RETURNS && v == 12345) out[0] = v;
}
int main() {
  unsigned *p, *out; CHECK(cudaMalloc(&p, 256 << 20)); CHECK(cudaMalloc(&out, 4096)); CHECK(cudaMemset(p, 0, 256 << 20));
  cudaEvent_t a, b; cudaEventCreate(&a); cudaEventCreate(&b);
  auto time = [&](auto launch) { float best = 1e9; for (int r = 0; r < 3; ++r) { cudaEventRecord(a); launch(); cudaEventRecord(b); CHECK(cudaDeviceSynchronize()); float ms; cudaEventElapsedTime(&ms, a, b); if (ms < best) best = ms; } return best; };
  puts("returns,lanes a sector,sectors,lines,words apart,cycles a warp instruction (1980 MHz)");
  for (int returns = 0; returns < 2; ++returns)
    for (int gap : {32, 64, 1024})
    for (unsigned lines : {1u, 2u, 4u, 16u, 64u, 1024u, 16384u}) {
      if (gap != 32 && (lines == 1 || lines > 64)) continue;
      for (int sectors : {1, 2, 4})
        for (int lanes : {1, 2, 4, 8}) {
          if (gap != 32 && lanes != 8) continue;
          const int blocks = 264, threads = 512;
          auto run = [&](int n) { return time([&] { if (returns) reds<true><<<blocks, threads>>>(p, lanes, sectors, lines, n, out, gap); else reds<false><<<blocks, threads>>>(p, lanes, sectors, lines, n, out, gap); }); };
          const float t = run(24) - run(8);
          printf("%d,%d,%d,%u,%d,%.3f\n", returns, lanes, sectors, lines, gap, t * 1e-3 * 1980e6 / (16.0 * blocks * threads / 32));
        }
    }
}
