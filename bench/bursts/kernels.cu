// Reads and sums of arrays that are in no cache, from 128 KB to 16 MB: what a short burst gets of the DRAM's bandwidth.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
// Each thread reads one word; no sum is ever stored.
#define READ(NAME) extern "C" __global__ void NAME(const float* in, float* out) { \
    const int i = blockIdx.x * blockDim.x + threadIdx.x; const float v = in[i]; if (v < 0) out[i] = v; }
#define READ4(NAME) extern "C" __global__ void NAME(const float4* in, float* out) { \
    const int i = blockIdx.x * blockDim.x + threadIdx.x; const float4 v = in[i]; if (v.x + v.y + v.z + v.w < 0) out[i] = v.x; }
#define READ2(NAME) extern "C" __global__ void NAME(const float* a, const float* b, float* out) { \
    const int i = blockIdx.x * blockDim.x + threadIdx.x; const float v = a[i] + b[i]; if (v < 0) out[i] = v; }
#define SUM(NAME) extern "C" __global__ void NAME(const float* a, const float* b, float* out) { \
    const int i = blockIdx.x * blockDim.x + threadIdx.x; out[i] = a[i] + b[i]; }
#define WRITE(NAME) extern "C" __global__ void NAME(float* out) { \
    const int i = blockIdx.x * blockDim.x + threadIdx.x; out[i] = i; }
READ(u_read_128k) READ(u_read_256k) READ(u_read_512k) READ(u_read_1m) READ(u_read_2m) READ(u_read_4m) READ(u_read_16m)
READ4(u_read4_256k) READ4(u_read4_1m) READ4(u_read4_4m) READ4(u_read4_16m)
READ2(u_read2_128k) READ2(u_read2_512k) READ2(u_read2_1m) READ2(u_read2_4m)
SUM(u_sum_128k) SUM(u_sum_512k) SUM(u_sum_1m) SUM(u_sum_4m)
WRITE(u_write_128k) WRITE(u_write_1m) WRITE(u_write_4m)
