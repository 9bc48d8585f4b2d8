// Cycles of a turn of loops with 1 to 8 warps on each scheduler.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
#include <cstdio>
#define LOOP(NAME, BODY) extern "C" __global__ void NAME(long long* out, float* sink, int n, float c) { \
    const int lane = threadIdx.x & 31, warp = threadIdx.x / 32; float x = 0, y = lane * 0; int i = 0; __syncthreads(); \
    const long long begin = clock64(); BODY; const long long end = clock64(); \
    if (lane == 0) out[warp] = begin, out[64 + warp] = end; sink[threadIdx.x] = x + y + i; }
LOOP(w_count, _Pragma("unroll 1") for (; i < n; ++i) x = x + 1)
LOOP(w_value, _Pragma("unroll 1") do x = x + 1; while (x < c))
LOOP(w_both, _Pragma("unroll 1") while (i < n && x < c) { x = x + 1; ++i; })
LOOP(w_mandel, float a = 0; float b = 0; float cr = -0.5f + y; float ci = 0.1f + y; _Pragma("unroll 1") while (i < n && a * a + b * b < 4.0f) { float t = a * a - b * b + cr; b = 2 * a * b + ci; a = t; i++; } x = a + b)
LOOP(w_long, float a = 1; float b = 2; float d = 3; float e = 4; _Pragma("unroll 1") for (; i < n; ++i) { _Pragma("unroll") for (int k = 0; k < 4; ++k) { a = a * x + y; b = b * x + y; d = d * x + y; e = e * x + y; } } x = a + b + d + e)
LOOP(w_longer, float a = 1; float b = 2; float d = 3; float e = 4; _Pragma("unroll 1") for (; i < n; ++i) { _Pragma("unroll") for (int k = 0; k < 16; ++k) { a = a * x + y; b = b * x + y; d = d * x + y; e = e * x + y; } } x = a + b + d + e)
#ifndef KERNELS_ONLY
#define RUN(NAME) for (int w : {1, 2, 3, 4, 6, 8}) { double t[2]; for (int r = 0; r < 3; ++r) { int n = r == 2 ? 1024 : 512; NAME<<<1, 128 * w>>>(out, sink, n, n); cudaMemcpy(h, out, 1024, cudaMemcpyDeviceToHost); \
    long long first = h[0], last = 0; for (int k = 0; k < 4 * w; ++k) { if (h[k] < first) first = h[k]; if (h[64 + k] > last) last = h[64 + k]; } t[r == 2] = last - first; } printf("%s,%d,%.2f\n", #NAME, w, (t[1] - t[0]) / 512); }
int main() {
  long long* out; float* sink; long long h[128];
  cudaMalloc(&out, 1024); cudaMalloc(&sink, 1 << 16);
  printf("loop,warps a scheduler,cycles a turn\n");
  RUN(w_count) RUN(w_value) RUN(w_both) RUN(w_mandel) RUN(w_long) RUN(w_longer)
}
#endif
