// Times fences behind nothing, loads and stores, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 fences.cu -o fences && ./fences > fences.csv
// One block of `warps` warps runs 64 turns of a loop; the cycles are those of a turn of the slowest warp, the least of five launches. A turn has the
// parts that its name lists, in that order: "load" and "store" are volatile accesses to a word of the thread, "wait" uses what the load returned, and
// "cta", "gl" and "sys" are fences.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
#define LOAD asm volatile("ld.volatile.global.u32 %0, [%1];" : "=r"(v) : "l"(at) : "memory");
#define STORE asm volatile("st.volatile.global.u32 [%0], %1;" ::"l"(at), "r"(x) : "memory");
#define WAIT x += v;
#define CTA asm volatile("membar.cta;" ::: "memory");
#define GL asm volatile("membar.gl;" ::: "memory");
#define SYS asm volatile("membar.sys;" ::: "memory");
#define CASES(C) C(0, "load wait", LOAD WAIT) C(1, "store", STORE) C(2, "cta", CTA) C(3, "gl", GL) C(4, "sys", SYS) \
  C(5, "load wait cta", LOAD WAIT CTA) C(6, "load wait gl", LOAD WAIT GL) C(7, "load gl", LOAD GL WAIT) C(8, "store cta", STORE CTA) \
  C(9, "store gl", STORE GL) C(10, "store sys", STORE SYS) C(11, "store gl load wait", STORE GL LOAD WAIT) \
  C(12, "gl load wait store gl", GL LOAD WAIT STORE GL) C(13, "load wait store gl", LOAD WAIT STORE GL) C(14, "gl gl", GL GL) C(15, "store gl gl", STORE GL GL) \
  C(16, "load wait sys", LOAD WAIT SYS)
template <int KIND> __global__ void fences(unsigned* words, long long* cycles) {
  unsigned* const at = words + blockIdx.x * blockDim.x + threadIdx.x;
  unsigned x = threadIdx.x, v = 0;
  STORE GL
  __syncthreads();
  const long long begin = clock64();
#pragma unroll 1
  for (int i = 0; i < 64; ++i) {
#define C(n, name, parts) if (KIND == n) { parts }
    CASES(C)
#undef C
  }
  const long long end = clock64();
  at[0] = x + v;
  if (threadIdx.x % 32 == 0) cycles[threadIdx.x / 32] = end - begin;
}
template <int KIND> void run(const char* name, unsigned* words, long long* cycles) {
  for (int warps : {1, 4, 16}) {
    long long best = 1ll << 60;
    for (int r = 0; r < 5; ++r) {
      fences<KIND><<<1, 32 * warps>>>(words, cycles);
      std::vector<long long> host(warps);
      CHECK(cudaMemcpy(host.data(), cycles, 8 * warps, cudaMemcpyDeviceToHost));
      best = std::min(best, *std::max_element(host.begin(), host.end()));
    }
    printf("%s,%d,%.1f\n", name, warps, best / 64.0);
  }
}
int main() {
  unsigned* words;
  long long* cycles;
  CHECK(cudaMalloc(&words, 1 << 20));
  CHECK(cudaMemset(words, 0, 1 << 20));
  CHECK(cudaMalloc(&cycles, 1024));
  puts("turn,warps,cycles");
#define C(n, name, parts) run<n>(name, words, cycles);
  CASES(C)
#undef C
}
