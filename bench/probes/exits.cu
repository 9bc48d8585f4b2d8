// Times loops that some lanes leave before others, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 exits.cu -o exits && ./exits > exits.csv
// Lanes leave a loop of 256 turns at `events` different turns before the last one, `lanes` at a time. One block of `warps` warps runs; the cycles are
// those of its slowest warp, the least of five launches. In "break" the lanes that leave wait behind the loop; in "work" they first do a
// chain of eight multiplications; in "nested" the loop is in a branch that half of the warp does not take.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
template <int KIND> __global__ void exits(int turns, int events, int lanes, int gap, long long* cycles, unsigned* out) {
  const int lane = threadIdx.x & 31, turn = lane / lanes < events ? turns - gap * (lane / lanes + 1) : turns;
  unsigned x = threadIdx.x, y = 0;
  __syncthreads();
  const long long begin = clock64();
  if (KIND != 2 || lane % 2 == 0) {
    int i = 0;
#pragma unroll 1
    while (true) {
      x = x * 1664525 + 1013904223;
      x = x * 1664525 + 1013904223;
      if (++i >= turn) {
        if (KIND == 1) {
          y = x;
#pragma unroll
          for (int k = 0; k < 8; ++k) y = y * 1103515245 + 12345;
        }
        break;
      }
    }
  }
  __syncwarp();
  const long long end = clock64();
  out[threadIdx.x] = x + y;
  if (lane == 0) cycles[threadIdx.x / 32] = end - begin;
}
int main() {
  long long* cycles;
  unsigned* out;
  CHECK(cudaMalloc(&cycles, 1024));
  CHECK(cudaMalloc(&out, 4096));
  const char* names[] = {"break", "work", "nested"};
  puts("kind,warps,events,lanes,gap,cycles");
  for (int kind = 0; kind < 3; ++kind)
    for (int warps : {1, 4, 8, 16, 32})
      for (int lanes : {1, 2})
        for (int gap : {1, 4})
          for (int events : {0, 1, 2, 4, 8, 15}) {
            long long best = 1ll << 60;
            for (int r = 0; r < 5; ++r) {
              if (kind == 0) exits<0><<<1, 32 * warps>>>(256, events, lanes, gap, cycles, out);
              if (kind == 1) exits<1><<<1, 32 * warps>>>(256, events, lanes, gap, cycles, out);
              if (kind == 2) exits<2><<<1, 32 * warps>>>(256, events, lanes, gap, cycles, out);
              std::vector<long long> host(32);
              CHECK(cudaMemcpy(host.data(), cycles, 8 * warps, cudaMemcpyDeviceToHost));
              best = std::min(best, *std::max_element(host.begin(), host.begin() + warps));
            }
            printf("%s,%d,%d,%d,%d,%lld\n", names[kind], warps, events, lanes, gap, best);
          }
}
