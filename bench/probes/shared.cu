// Measures the cycles that an access to shared memory takes the pipe, by its width and the lanes' addresses.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
#include <cstdio>
#include <cstring>
#include <vector>
#include <random>
#include <algorithm>
#include <string>
// 16 warps repeat one access 64 times; time[w] is a warp's. Lanes with a negative index take no part.
template <int WORDS, bool STORE>
__global__ void repeat(const int* index, long* begin, long* end, float* out) {
  extern __shared__ __align__(16) float s[];
  const int lane = threadIdx.x & 31, at = index[lane];
  const bool on = at >= 0;
  const unsigned a = (unsigned)__cvta_generic_to_shared(s) + (on ? at : 0) * WORDS * 4;
  float v = lane;
  int sum = 0;
  __syncthreads();
  long t0 = clock64();
  if (on) {
#pragma unroll 1
    for (int turn = 0; turn < 4; ++turn) {
#pragma unroll
      for (int i = 0; i < 32; ++i) {
        int x = 0, y = 0, z = 0, w = 0;
        if (STORE) {
          if (WORDS == 1) asm volatile("st.volatile.shared.b32 [%0], %1;" ::"r"(a), "f"(v) : "memory");
          if (WORDS == 2) asm volatile("st.volatile.shared.v2.b32 [%0], {%1, %1};" ::"r"(a), "f"(v) : "memory");
          if (WORDS == 4) asm volatile("st.volatile.shared.v4.b32 [%0], {%1, %1, %1, %1};" ::"r"(a), "f"(v) : "memory");
        } else {
          if (WORDS == 1) asm volatile("ld.volatile.shared.b32 %0, [%1];" : "=r"(x) : "r"(a) : "memory");
          if (WORDS == 2) asm volatile("ld.volatile.shared.v2.b32 {%0, %1}, [%2];" : "=r"(x), "=r"(y) : "r"(a) : "memory");
          if (WORDS == 4) asm volatile("ld.volatile.shared.v4.b32 {%0, %1, %2, %3}, [%4];" : "=r"(x), "=r"(y), "=r"(z), "=r"(w) : "r"(a) : "memory");
          sum ^= x ^ y;
          sum ^= z ^ w;
        }
      }
    }
  }
  __syncthreads();
  long t1 = clock64();
  if (lane == 0) begin[threadIdx.x / 32] = t0, end[threadIdx.x / 32] = t1;
  out[threadIdx.x] = s[threadIdx.x] + sum;
}
struct Pattern { std::string name; std::vector<int> index; };
template <int WORDS, bool STORE> void run(const Pattern& p, int* index, long* times) {
  cudaMemcpy(index, p.index.data(), 128, cudaMemcpyHostToDevice);
  long h[64];
  for (int r = 0; r < 2; ++r) { repeat<WORDS, STORE><<<1, 512, 64 << 10>>>(index, times, times + 32, (float*)(times + 64)); cudaMemcpy(h, times, 512, cudaMemcpyDeviceToHost); }
  long first = h[0], last = h[32];
  for (int w = 0; w < 16; ++w) { if (h[w] < first) first = h[w]; if (h[32 + w] > last) last = h[32 + w]; }
  printf("%s,%d,%s,%.3f", STORE ? "store" : "load", WORDS * 32, p.name.c_str(), (last - first) / (16.0 * 128));
  for (int i : p.index) printf(",%d", i);
  printf("\n");
}
int main() {
  std::vector<Pattern> ps;
  const auto add = [&](std::string n, auto f) { Pattern p{n, {}}; for (int l = 0; l < 32; ++l) p.index.push_back(f(l)); ps.push_back(p); };
  add("own", [](int l) { return l; });
  add("one", [](int) { return 0; });
  for (int d : {2, 4, 8, 16}) add("lane/" + std::to_string(d), [=](int l) { return l / d; });
  for (int d : {2, 4, 8, 16}) add("lane%" + std::to_string(d), [=](int l) { return l % d; });
  for (int d : {2, 3, 4, 5, 8, 16, 32}) add("stride" + std::to_string(d), [=](int l) { return l * d; });
  for (int d : {1, 2, 4, 8, 16}) add("xor" + std::to_string(d), [=](int l) { return l ^ d; });
  add("reverse", [](int l) { return 31 - l; });
  add("bits", [](int l) { return ((l & 1) << 4) | ((l & 2) << 2) | (l & 4) | ((l & 8) >> 2) | ((l & 16) >> 4); });
  for (int n : {1, 2, 4, 8, 12, 16, 20, 24}) add("first" + std::to_string(n), [=](int l) { return l < n ? l : -1; });
  for (int d : {2, 4, 8}) add("every" + std::to_string(d), [=](int l) { return l % d == 0 ? l : -1; });
  for (int d : {2, 4, 8}) add("packed" + std::to_string(d), [=](int l) { return l % d == 0 ? l / d : -1; });
  for (int d : {2, 4, 8, 16}) add("groups" + std::to_string(d), [=](int l) { return (l % d) * 32 + l / d; });
  for (int d : {4, 8, 16}) add("shift" + std::to_string(d), [=](int l) { return l < d ? l : l + 64 - d % 64; });
  std::mt19937 r(1);
  for (int of : {2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 256})
    for (int k = 0; k < 6; ++k) add("random" + std::to_string(of) + "_" + std::to_string(k), [&](int) { return int(r() % of); });
  for (int k = 0; k < 10; ++k) { std::vector<int> p(32); for (int i = 0; i < 32; ++i) p[i] = i; std::shuffle(p.begin(), p.end(), r); add("permuted_" + std::to_string(k), [&](int l) { return p[l]; }); }
  for (int k = 0; k < 12; ++k) add("holes_" + std::to_string(k), [&](int l) { return r() % 2 ? int(r() % 32) : -1; });
  int* index; long* times; cudaMalloc(&index, 128); cudaMalloc(&times, 4096);
  cudaFuncSetAttribute(repeat<1, false>, cudaFuncAttributeMaxDynamicSharedMemorySize, 64 << 10);
  cudaFuncSetAttribute(repeat<2, false>, cudaFuncAttributeMaxDynamicSharedMemorySize, 64 << 10);
  cudaFuncSetAttribute(repeat<4, false>, cudaFuncAttributeMaxDynamicSharedMemorySize, 64 << 10);
  cudaFuncSetAttribute(repeat<1, true>, cudaFuncAttributeMaxDynamicSharedMemorySize, 64 << 10);
  cudaFuncSetAttribute(repeat<2, true>, cudaFuncAttributeMaxDynamicSharedMemorySize, 64 << 10);
  cudaFuncSetAttribute(repeat<4, true>, cudaFuncAttributeMaxDynamicSharedMemorySize, 64 << 10);
  printf("op,bits,pattern,cycles"); for (int l = 0; l < 32; ++l) printf(",lane%d", l); printf("\n");
  for (const Pattern& p : ps) { run<1, false>(p, index, times); run<2, false>(p, index, times); run<4, false>(p, index, times); run<1, true>(p, index, times); run<2, true>(p, index, times); run<4, true>(p, index, times); }
  fprintf(stderr, "%s\n", cudaGetErrorString(cudaDeviceSynchronize()));
}
