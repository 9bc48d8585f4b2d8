// Reads an array that the L2 holds again and again with all cores, by vectors, by words and by a word of each sector.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
#include <cstdio>
// A lane takes 16 bytes (MODE 0), 4 bytes (1), or 4 bytes of a sector of its own (2).
template <int MODE> __global__ void readall(const float* in, long floats, int passes, long long* begin, long long* end, float* sink) {
  float s = 0;
  const long t = blockIdx.x * (long)blockDim.x + threadIdx.x, n = gridDim.x * (long)blockDim.x;
  long long t0 = clock64();
  for (int p = 0; p < passes; ++p) {
    const long off = (p * 7919l * 32) % floats;
    if (MODE == 0) for (long i = t * 4; i < floats; i += n * 4 * 4) {
      float4 v[4];
#pragma unroll
      for (int k = 0; k < 4; ++k) { long j = i + k * n * 4 + off; if (j >= floats) j -= floats; if (j >= floats) j -= floats; v[k] = __ldcg((const float4*)(in + j)); }
#pragma unroll
      for (int k = 0; k < 4; ++k) s += v[k].x + v[k].w;
    }
    if (MODE == 1) for (long i = t; i < floats; i += n * 8) {
      float v[8];
#pragma unroll
      for (int k = 0; k < 8; ++k) { long j = i + k * n + off; if (j >= floats) j -= floats; if (j >= floats) j -= floats; v[k] = __ldcg(in + j); }
#pragma unroll
      for (int k = 0; k < 8; ++k) s += v[k];
    }
    if (MODE == 2) for (long i = t * 8; i < floats; i += n * 8 * 4) {
      float v[4];
#pragma unroll
      for (int k = 0; k < 4; ++k) { long j = i + k * n * 8 + off; if (j >= floats) j -= floats; if (j >= floats) j -= floats; v[k] = __ldcg(in + j); }
#pragma unroll
      for (int k = 0; k < 4; ++k) s += v[k];
    }
  }
  long long t1 = clock64();
  if (threadIdx.x == 0) begin[blockIdx.x] = t0, end[blockIdx.x] = t1;
  if (s == 12345) sink[t] = s;
}
template <int MODE> void run(const char* name, const float* in, long bytes, long long* tb, float* sink) {
  long long h[2048];
  for (int blocks : {132, 264}) for (int threads : {512, 1024}) {
    if (blocks == 264 && threads == 1024) continue;
    long floats = bytes / 4; int passes = (64l << 20) / bytes;
    for (int r = 0; r < 2; ++r) readall<MODE><<<blocks, threads>>>(in, floats, passes, tb, tb + 1024, sink);
    cudaMemcpy(h, tb, 2048 * 8, cudaMemcpyDeviceToHost);
    double most = 0, sum = 0;
    for (int b = 0; b < blocks; ++b) { double d = h[1024 + b] - h[b]; sum += d; if (d > most) most = d; }
    printf("%s,%ld KB,%d x %d,%.0f cycles,%.0f B/cycle (mean block %.0f)\n", name, bytes >> 10, blocks, threads, most, double(bytes) * passes * (1) / most, double(bytes) * passes / (sum / blocks));
  }
}
int main() {
  float* in; float* sink; long long* tb;
  cudaMalloc(&in, 64 << 20); cudaMalloc(&sink, 1 << 24); cudaMalloc(&tb, 1 << 16); cudaMemset(in, 0, 64 << 20);
  for (long b : {1l << 20, 4l << 20, 16l << 20}) { run<0>("float4", in, b, tb, sink); run<1>("float", in, b, tb, sink); run<2>("sector", in, b, tb, sink); }
  fprintf(stderr, "%s\n", cudaGetErrorString(cudaDeviceSynchronize()));
}
