// Cycles of a turn of loops with one warp: what branches cost.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
#include <cstdio>
#define LOOP(NAME, BODY) extern "C" __global__ void NAME(long long* out, float* sink, int n, float c) { \
    const int lane = threadIdx.x; float x = 0, y = lane; int i = 0; \
    const long long begin = clock64(); BODY; const long long end = clock64(); \
    out[lane] = end - begin; sink[lane] = x + y + i; }
LOOP(o_count, _Pragma("unroll 1") for (; i < n; ++i) x = x + 1)
LOOP(o_value, _Pragma("unroll 1") do x = x + 1; while (x < c))
LOOP(o_both, _Pragma("unroll 1") while (i < n && x < c) { x = x + 1; ++i; })
LOOP(o_leave, x = -32.0f * lane; _Pragma("unroll 1") do x = x + 1; while (x < c))
LOOP(o_parabola, float q = 0; _Pragma("unroll 1") while (i < n && q < 4) { y = x * y + 1e-3f; x = x * 1e-3f; q = x * x + y * y * 1e-9f; ++i; })
#define LONG(v) { v = v * 1.01f + 1; v = v * v + 2; v = v * 0.5f + y; v = v * v + 3; v = v * 1.02f + y; v = v * v + 1; v = v * 0.1f + 4; v = v * v + y; \
    v = v * 1.03f + 1; v = v * v + 2; v = v * 0.25f + y; v = v * v + 5; v = v * 1.04f + y; v = v * v + 1; v = v * 0.2f + 4; v = v * v + y; v = v * 1e-9f; }
LOOP(o_skip, _Pragma("unroll 1") for (; i < n; ++i) { x = x + 1; if (x < 0) LONG(x) })
LOOP(o_enter, _Pragma("unroll 1") for (; i < n; ++i) { y = y + 1; if (y >= 0) LONG(x) })
LOOP(o_half, _Pragma("unroll 1") for (; i < n; ++i) { y = y + 1; if (lane & 1) LONG(x) })
LOOP(o_split, _Pragma("unroll 1") for (; i < n; ++i) { y = y + 1; if (lane & 1) LONG(x) else { LONG(y) y = y + 7; } })
LOOP(o_break, _Pragma("unroll 1") for (;;) { x = x + 1; if (x > c) break; y = y * x; if (++i > n) break; })
#ifndef KERNELS_ONLY
#define RUN(NAME) { for (int r = 0; r < 2; ++r) { NAME<<<1, 32>>>(out, sink, 1024, 1024); cudaMemcpy(h, out, 256, cudaMemcpyDeviceToHost); } long long m = 0; for (long long v : h) m = v > m ? v : m; \
    NAME<<<1, 32>>>(out, sink, 2048, 2048); cudaMemcpy(h, out, 256, cudaMemcpyDeviceToHost); long long k = 0; for (long long v : h) k = v > k ? v : k; \
    printf("%s,%lld,%lld,%.2f\n", #NAME, m, k, (k - m) / 1024.0); }
int main() {
  long long* out; float* sink; long long h[32];
  cudaMalloc(&out, 256); cudaMalloc(&sink, 256);
  printf("loop,cycles 1024,cycles 2048,cycles a turn\n");
  RUN(o_count) RUN(o_value) RUN(o_both) RUN(o_leave) RUN(o_parabola) RUN(o_skip) RUN(o_enter) RUN(o_half) RUN(o_split) RUN(o_break)
}
#endif
