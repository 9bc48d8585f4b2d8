// Times reductions, atomics, stores and loads of all cores at hashed lines, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 scattered.cu -o scattered && ./scattered
// The cycles of 12 instructions of each warp are those of 16 less those of 4. "held" lines are in the L2 before.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ __forceinline__ unsigned hash(unsigned x) { x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; return x ^ x >> 16; }
// OP 0: red.add, 1: atom.add, 2: store, 3: load past the L1.
template <int OP> __global__ void scattered(unsigned* p, unsigned mask, int lanes, int n, int line_lanes, unsigned salt, long long* begin, long long* end, unsigned* out) {
  const unsigned lane = threadIdx.x & 31, warp = (blockIdx.x * blockDim.x + threadIdx.x) >> 5;
  __syncthreads();
  const long long t0 = clock64();
  unsigned v = 0;
  if (lane < lanes)
    for (int k = 0; k < n; ++k) {
      // line_lanes lanes in a row share a line (one sector each up to four, then more words)
      const unsigned at = (hash((warp * 64 + k) * 32 + lane / line_lanes + salt) & mask & ~31u) | (line_lanes == 1 ? hash(lane + k) & 31 : (lane % line_lanes) * (32 / line_lanes));
      if (OP == 0) asm volatile("red.global.add.u32 [%0], %1;" :: "l"(p + at), "r"(lane + k) : "memory");
      if (OP == 1) { unsigned r; asm volatile("atom.global.add.u32 %0, [%1], %2;" : "=r"(r) : "l"(p + at), "r"(lane + k) : "memory"); v += r; }
      if (OP == 2) asm volatile("st.global.u32 [%0], %1;" :: "l"(p + at), "r"(lane + k) : "memory");
      if (OP == 3) { unsigned r; asm volatile("ld.global.cg.u32 %0, [%1];" : "=r"(r) : "l"(p + at) : "memory"); v += r; }
    }
  if (v == 12345) out[0] = v;
  if (OP == 0 || OP == 2) __threadfence();
  __syncthreads();
  if (threadIdx.x == 0) begin[blockIdx.x] = t0, end[blockIdx.x] = clock64();
}
__global__ void touch(const unsigned* p, size_t n, unsigned* out) { unsigned v = 0; for (size_t i = blockIdx.x * size_t(blockDim.x) + threadIdx.x; i < n; i += size_t(gridDim.x) * blockDim.x) v += p[i]; if (v == 12345) out[1] = v; }
int main() {
  unsigned *p, *out, *big; long long* tb; CHECK(cudaMalloc(&p, 64 << 20)); CHECK(cudaMalloc(&big, 256 << 20)); CHECK(cudaMalloc(&out, 4096)); CHECK(cudaMalloc(&tb, 1 << 20)); CHECK(cudaMemset(p, 0, 64 << 20)); CHECK(cudaMemset(big, 0, 256 << 20));
  std::vector<long long> h(1 << 16);
  FILE* f = fopen("scattered.csv", "w");
  fputs("op,lanes,lanes a line,KB,state,blocks,warps,cycles of the slowest block,instructions of a warp\n", f);
  const char* names[] = {"red", "atom", "store", "load"};
  for (int op = 0; op < 4; ++op) for (int kb : {64, 256, 16384}) for (int state = 0; state < 2; ++state) for (int blocks : {33, 66, 132}) for (int config = 0; config < 6; ++config) {
    const int lanes = (const int[]){1, 4, 16, 32, 32, 32}[config], line_lanes = (const int[]){1, 1, 1, 1, 4, 8}[config];
    if (blocks != 132 && config != 3 && config != 0) continue;
    for (int n : {4, 16}) {
      long long best = 1ll << 60;
      for (int r = 0; r < 4; ++r) {
        if (state == 0) { touch<<<264, 1024>>>(big, size_t(64) << 20, out); touch<<<264, 1024>>>(big, size_t(64) << 20, out); } else touch<<<264, 1024>>>(p, size_t(kb) << 8, out);
        const unsigned mask = (unsigned(kb) << 8) - 1, salt = 977 * r;
        if (op == 0) scattered<0><<<blocks, 1024>>>(p, mask, lanes, n, line_lanes, salt, tb, tb + 2048, out);
        if (op == 1) scattered<1><<<blocks, 1024>>>(p, mask, lanes, n, line_lanes, salt, tb, tb + 2048, out);
        if (op == 2) scattered<2><<<blocks, 1024>>>(p, mask, lanes, n, line_lanes, salt, tb, tb + 2048, out);
        if (op == 3) scattered<3><<<blocks, 1024>>>(p, mask, lanes, n, line_lanes, salt, tb, tb + 2048, out);
        CHECK(cudaMemcpy(h.data(), tb, 4096 * 8, cudaMemcpyDeviceToHost));
        long long most = 0; for (int b = 0; b < blocks; ++b) most = std::max(most, h[2048 + b] - h[b]);
        best = std::min(best, most);
      }
      fprintf(f, "%s,%d,%d,%d,%s,%d,32,%lld,%d\n", names[op], lanes, line_lanes, kb, state ? "held" : "cold", blocks, best, n);
    }
  }
  fclose(f);
}
