// Times calls of functions on a real GPU: through pointers, with registers that live across them, and recursion.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 calls.cu -o calls && ./calls > calls.csv
// One warp goes through each kernel. The cycles are those of a call and its return, from a loop of 256 dependent turns, the least of five launches. The
// lanes call as many functions as `functions` says. In "live" 12 registers live across the call. In "recursion" a function calls itself 16 deep, and the
// cycles are those of one of its calls. "none" is the loop alone.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
typedef int (*function)(int);
template <int N> __device__ __noinline__ int add(int x) { return x * 3 + N; }
__device__ function table[4] = {add<1>, add<2>, add<3>, add<4>};
__device__ __noinline__ int depth(int n, int x) { return n == 0 ? x : depth(n - 1, x * 3 + n) + n; }
constexpr int kTurns = 256;
extern "C" __global__ void none(int* out, long long* cycles, int mask) {
  int x = threadIdx.x;
  const long long begin = clock64();
#pragma unroll 1
  for (int i = 0; i < kTurns; ++i) x = x * 3 + (mask ^ 1);
  cycles[0] = clock64() - begin;
  out[threadIdx.x] = x;
}
extern "C" __global__ void pointer(int* out, long long* cycles, int mask) {
  int x = threadIdx.x;
  const function f = table[threadIdx.x & mask];
  const long long begin = clock64();
#pragma unroll 1
  for (int i = 0; i < kTurns; ++i) x = f(x);
  cycles[0] = clock64() - begin;
  out[threadIdx.x] = x;
}
extern "C" __global__ void live(int* out, long long* cycles, int mask) {
  int x[12];
  for (int k = 0; k < 12; ++k) x[k] = threadIdx.x * (k + 1) ^ mask;
  const function f = table[threadIdx.x & mask];
  const long long begin = clock64();
#pragma unroll 1
  for (int i = 0; i < kTurns; ++i) {
    const int y = f(x[0]);
#pragma unroll
    for (int k = 0; k < 12; ++k) x[k] += y;
  }
  cycles[0] = clock64() - begin;
  int sum = 0;
  for (int k = 0; k < 12; ++k) sum = sum * 5 + x[k];
  out[threadIdx.x] = sum;
}
extern "C" __global__ void recursion(int* out, long long* cycles, int mask) {
  int x = threadIdx.x;
  const long long begin = clock64();
#pragma unroll 1
  for (int i = 0; i < kTurns / 16; ++i) x = depth(16, x ^ mask);
  cycles[0] = clock64() - begin;
  out[threadIdx.x] = x;
}
int main() {
  int* out;
  long long* cycles;
  CHECK(cudaMalloc(&out, 128));
  CHECK(cudaMalloc(&cycles, 8));
  printf("kernel,functions,cycles_a_call\n");
  const auto time = [&](const char* name, void (*kernel)(int*, long long*, int), int mask) {
    long long best = 1ll << 60;
    for (int i = 0; i < 5; ++i) {
      kernel<<<1, 32>>>(out, cycles, mask);
      CHECK(cudaDeviceSynchronize());
      long long now;
      CHECK(cudaMemcpy(&now, cycles, 8, cudaMemcpyDeviceToHost));
      best = std::min(best, now);
    }
    printf("%s,%d,%.2f\n", name, mask + 1, double(best) / kTurns);
  };
  time("none", none, 0);
  for (int mask : {0, 1, 3}) time("pointer", pointer, mask);
  for (int mask : {0, 3}) time("live", live, mask);
  time("recursion", recursion, 0);
}
