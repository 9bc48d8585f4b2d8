// Times divisions, reciprocals and roots by their operands, and additions in shared memory, on a real GPU (probes/README.md).
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 times.cu -o times && ./times FOLDER > times.csv
// FOLDER receives exponents.bin: the cycles of a division by all pairs of exponents, for three pairs of fractions, as 16-bit words.
#include <cstdio>
#include <cstdint>
#include <cstring>
#include <cmath>
#include <vector>
#include <string>
#include <algorithm>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ __forceinline__ unsigned now() { unsigned t; asm volatile("mov.u32 %0, %%clock;" : "=r"(t) :: "memory"); return t; }
__device__ __forceinline__ unsigned hash(unsigned x) { x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; return x ^ x >> 16; }

// A division for each pair of exponents.
__global__ void exponents(unsigned short* out, unsigned am, unsigned bm) {
  const unsigned pair = blockIdx.x;
  if (threadIdx.x) return;
  float a = __uint_as_float((pair >> 8) << 23 | am), b = __uint_as_float((pair & 255) << 23 | bm);
  unsigned t = 0;
  float q = 0;
#pragma unroll 1
  for (int k = 0; k < 2; ++k) {
    const unsigned t0 = now();
    asm volatile("div.rn.f32 %0, %1, %2;" : "=f"(q) : "f"(a), "f"(b));
    t = now() - t0;
    a = __uint_as_float(__float_as_uint(a) ^ (__float_as_uint(q) & 0x00000000u & t));
  }
  out[pair] = (unsigned short)min(t + (q == 123.0f), 65535u);
}
// Chains of one op, by class of operands.
template <int OP> struct Kind { using T = float; };
template <> struct Kind<3> { using T = double; };
template <> struct Kind<4> { using T = double; };
template <> struct Kind<5> { using T = double; };
template <int OP, class T> __device__ __forceinline__ T op(T a, T b) {
  T q;
  if constexpr (OP == 0) asm volatile("div.rn.f32 %0, %1, %2;" : "=f"(q) : "f"(a), "f"(b));
  if constexpr (OP == 1) asm volatile("rcp.rn.f32 %0, %1;" : "=f"(q) : "f"(a));
  if constexpr (OP == 2) asm volatile("sqrt.rn.f32 %0, %1;" : "=f"(q) : "f"(a));
  if constexpr (OP == 3) asm volatile("div.rn.f64 %0, %1, %2;" : "=d"(q) : "d"(a), "d"(b));
  if constexpr (OP == 4) asm volatile("rcp.rn.f64 %0, %1;" : "=d"(q) : "d"(a));
  if constexpr (OP == 5) asm volatile("sqrt.rn.f64 %0, %1;" : "=d"(q) : "d"(a));
  if constexpr (OP == 6) asm volatile("div.rn.ftz.f32 %0, %1, %2;" : "=f"(q) : "f"(a), "f"(b));
  if constexpr (OP == 7) asm volatile("rcp.rn.ftz.f32 %0, %1;" : "=f"(q) : "f"(a));
  if constexpr (OP == 8) asm volatile("sqrt.rn.ftz.f32 %0, %1;" : "=f"(q) : "f"(a));
  return q;
}
__device__ float mix(float a, float q, unsigned zero) { return __uint_as_float(__float_as_uint(a) | (__float_as_uint(q) & zero)); }
__device__ double mix(double a, double q, unsigned zero) {
  return __hiloint2double(__double2hiint(a) | (__double2hiint(q) & zero), __double2loint(a) | (__double2loint(q) & zero));
}
template <int OP, class T> __global__ void chain(const T* as, const T* bs, unsigned zero, int n, unsigned* times, T* out) {
  T a = as[threadIdx.x & 31], b = bs[threadIdx.x & 31], q = 0;
  unsigned t0 = 0;
#pragma unroll 1
  for (int k = -4; k < n; ++k) {
    if (k == 0) { t0 = now(); }
    q = op<OP, T>(a, b);
    a = mix(a, q, zero);
  }
  const unsigned t = now() - t0;
  out[threadIdx.x] = q;
  if (threadIdx.x % 32 == 0) times[threadIdx.x / 32] = t;
}
template <int OP, class T> void chains(const char* name, const std::vector<std::pair<const char*, std::vector<std::pair<T, T>>>>& classes) {
  T *a, *b, *out; unsigned* times;
  CHECK(cudaMalloc(&a, 4096)); CHECK(cudaMalloc(&b, 4096)); CHECK(cudaMalloc(&out, 65536)); CHECK(cudaMalloc(&times, 4096));
  for (auto& [label, values] : classes) {
    for (int lanes : {32, 1}) {
      if (lanes == 1 && values.size() > 1) continue;
      T ha[32], hb[32];
      for (int i = 0; i < 32; ++i) {
        const auto v = i < lanes ? values[i % values.size()] : std::pair<T, T>(T(3), T(7));
        ha[i] = v.first; hb[i] = v.second;
      }
      CHECK(cudaMemcpy(a, ha, sizeof ha, cudaMemcpyHostToDevice)); CHECK(cudaMemcpy(b, hb, sizeof hb, cudaMemcpyHostToDevice));
      double result[3];
      const int warps[] = {1, 4, 16};
      for (int w = 0; w < 3; ++w) {
        unsigned host[32];
        for (int twice = 0; twice < 2; ++twice) { chain<OP, T><<<1, 32 * warps[w]>>>(a, b, 0, 128, times, out); CHECK(cudaDeviceSynchronize()); }
        CHECK(cudaMemcpy(host, times, 4 * warps[w], cudaMemcpyDeviceToHost));
        result[w] = double(*std::max_element(host, host + warps[w])) / 128;
      }
      printf("chain,%s,%s,%d,%.2f,%.2f,%.2f\n", name, label, lanes, result[0], result[1], result[2]);
    }
  }
}
// Additions in shared memory; the pattern gives the word of each lane.
template <int KIND> __global__ void ones(unsigned* out, int pattern, unsigned words, unsigned one, int n, unsigned* times) {
  __shared__ unsigned s[4096];
  for (int i = threadIdx.x; i < 4096; i += blockDim.x) s[i] = 0;
  const unsigned lane = threadIdx.x & 31;
  unsigned at[4];
  for (int k = 0; k < 4; ++k) {
    const unsigned h = hash(threadIdx.x * 4 + k);
    at[k] = pattern == 0 ? h % words : pattern == 1 ? lane % words : pattern == 2 ? (lane % words) * 32 : lane / (32 / words);
  }
  __syncthreads();
  unsigned t0 = 0;
#pragma unroll 1
  for (int r = -1; r < n; ++r) {
    if (r == 0) { __syncthreads(); t0 = now(); }
#pragma unroll
    for (int k = 0; k < 4; ++k) {
      if (KIND == 0) atomicAdd(&s[at[k]], 1u);
      else if (KIND == 1) atomicAdd(&s[at[k]], one);
      else s[at[k]] = r;
    }
  }
  __syncthreads();
  const unsigned t = now() - t0;
  if (threadIdx.x % 32 == 0) times[threadIdx.x / 32] = t;
  for (int i = threadIdx.x; i < 4096; i += blockDim.x) out[i] = s[i];
}
template <int KIND> void ones_all(const char* name) {
  unsigned *out, *times;
  CHECK(cudaMalloc(&out, 65536)); CHECK(cudaMalloc(&times, 4096));
  const char* labels[] = {"random", "consecutive", "one_bank", "grouped"};
  for (int pattern = 0; pattern < 4; ++pattern)
    for (unsigned words : {1u, 2u, 4u, 8u, 16u, 32u, 64u, 256u, 1024u, 4096u}) {
      if (pattern && words > 32) continue;
      double result[4];
      const int warps[] = {1, 4, 8, 32};
      for (int w = 0; w < 4; ++w) {
        unsigned host[32];
        ones<KIND><<<1, 32 * warps[w]>>>(out, pattern, words, 1, 64, times);
        CHECK(cudaDeviceSynchronize());
        CHECK(cudaMemcpy(host, times, 4 * warps[w], cudaMemcpyDeviceToHost));
        result[w] = double(*std::max_element(host, host + warps[w])) / 256;
      }
      printf("shared,%s,%s,%u,%.2f,%.2f,%.2f,%.2f\n", name, labels[pattern], words, result[0], result[1], result[2], result[3]);
    }
}
int main(int argc, char** argv) {
  const std::string dir = argc > 1 ? argv[1] : ".";
  puts("kind,op,operands or pattern,lanes with them or words,cycles with 1 warp,4 warps,16 warps (chain) or 8 warps (shared),32 warps (shared)");
  {
    unsigned short* out; CHECK(cudaMalloc(&out, 131072)); std::vector<unsigned short> host(65536);
    const unsigned mantissas[][2] = {{0, 0}, {0x7fffff, 0x7fffff}, {0x2aaaaa, 0x555555}};
    FILE* file = fopen((dir + "/exponents.bin").c_str(), "wb");
    for (auto& m : mantissas) {
      exponents<<<65536, 32>>>(out, m[0], m[1]); CHECK(cudaDeviceSynchronize());
      exponents<<<65536, 32>>>(out, m[0], m[1]); CHECK(cudaDeviceSynchronize());
      CHECK(cudaMemcpy(host.data(), out, 131072, cudaMemcpyDeviceToHost));
      fwrite(host.data(), 2, 65536, file);
    }
    fclose(file);
  }
  const float inf = INFINITY, nan = NAN, sub = 1e-41f, big = 1e38f, small = 1e-37f;
  using F = std::vector<std::pair<const char*, std::vector<std::pair<float, float>>>>;
  const F div32 = {{"normal", {{3, 7}}}, {"zero/x", {{0, 7}}}, {"sub/x", {{sub, 7}}}, {"small/x", {{2e-38f, 1.5f}}}, {"x/zero", {{3, 0}}}, {"x/sub", {{1e-5f, sub}}}, {"inf/x", {{inf, 7}}},
    {"x/inf", {{3, inf}}}, {"nan/x", {{nan, 7}}}, {"0/0", {{0, 0}}}, {"inf/inf", {{inf, inf}}}, {"far_overflow", {{big, small}}}, {"far_underflow", {{small, big}}}, {"sub_result", {{2e-38f, 100}}}, {"x/big", {{3, 2e38f}}},
    {"mix zero+normal", {{0, 7}, {3, 7}}}, {"mix zero+sub", {{0, 7}, {sub, 7}}}, {"mix zero+sub+inf", {{0, 7}, {sub, 7}, {inf, 7}}}};
  chains<0, float>("div.rn.f32", div32); chains<6, float>("div.rn.ftz.f32", div32);
  const F one32 = {{"normal", {{3, 0}}}, {"zero", {{0, 0}}}, {"-zero", {{-0.0f, 0}}}, {"sub", {{sub, 0}}}, {"negative", {{-3, 0}}}, {"small", {{1e-37f, 0}}}, {"1e-32", {{1e-32f, 0}}}, {"big", {{3e38f, 0}}}, {"1e38", {{1e38f, 0}}}, {"inf", {{inf, 0}}}, {"nan", {{nan, 0}}},
    {"mix zero+normal", {{0, 0}, {3, 0}}}, {"mix zero+sub", {{0, 0}, {sub, 0}}}};
  chains<1, float>("rcp.rn.f32", one32); chains<2, float>("sqrt.rn.f32", one32); chains<7, float>("rcp.rn.ftz.f32", one32); chains<8, float>("sqrt.rn.ftz.f32", one32);
  using D = std::vector<std::pair<const char*, std::vector<std::pair<double, double>>>>;
  const D div64 = {{"normal", {{3, 7}}}, {"zero/x", {{0, 7}}}, {"sub/x", {{1e-310, 7}}}, {"small/x", {{1e-300, 1.5}}}, {"x/zero", {{3, 0}}}, {"x/sub", {{1e-5, 1e-310}}}, {"inf/x", {{inf, 7}}}, {"x/inf", {{3, inf}}}, {"nan/x", {{nan, 7}}},
    {"0/0", {{0, 0}}}, {"far_overflow", {{1e308, 1e-300}}}, {"far_underflow", {{1e-300, 1e308}}}, {"sub_result", {{1e-290, 1e20}}}, {"x/big", {{3, 1e308}}}, {"mix zero+normal", {{0, 7}, {3, 7}}}};
  chains<3, double>("div.rn.f64", div64);
  const D one64 = {{"normal", {{3, 0}}}, {"zero", {{0, 0}}}, {"sub", {{1e-310, 0}}}, {"negative", {{-3, 0}}}, {"small", {{1e-307, 0}}}, {"1e-300", {{1e-300, 0}}}, {"big", {{1e308, 0}}}, {"inf", {{inf, 0}}}, {"nan", {{nan, 0}}}, {"mix zero+normal", {{0, 0}, {3, 0}}}};
  chains<4, double>("rcp.rn.f64", one64); chains<5, double>("sqrt.rn.f64", one64);
  ones_all<0>("inc"); ones_all<1>("add"); ones_all<2>("store");
}
