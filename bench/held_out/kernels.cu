// Kernels that no parameter of the preset h200 was fitted to. Inputs count up (0, 1, 2 ...); what looks random is hashed from them.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>

__device__ __forceinline__ unsigned hash(unsigned x) {
  x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16;
  return x;
}

// Inclusive prefix sums of 256 values a block, in shared memory.
extern "C" __global__ void h_scan(const float* in, float* out, int n) {
  __shared__ float s[2][256];
  const int t = threadIdx.x, i = blockIdx.x * 256 + t;
  s[0][t] = i < n ? in[i] : 0;
  __syncthreads();
  int from = 0;
  for (int d = 1; d < 256; d *= 2) {
    s[1 - from][t] = t >= d ? s[from][t] + s[from][t - d] : s[from][t];
    from = 1 - from;
    __syncthreads();
  }
  if (i < n) out[i] = s[from][t];
}

// Rows of 4 to 19 entries with hashed columns.
extern "C" __global__ void h_spmv(const float* values, const float* x, float* y, int rows, int mask) {
  const int row = blockIdx.x * blockDim.x + threadIdx.x;
  if (row >= rows) return;
  const int length = 4 + (hash(row) & 15);
  float sum = 0;
  for (int k = 0; k < length; ++k) sum += values[k * rows + row] * x[hash(row * 32 + k) & mask];
  y[row] = sum;
}

// Forces among n bodies, 128 at a time through shared memory.
extern "C" __global__ void h_nbody(const float4* bodies, float4* out, int n) {
  __shared__ float4 tile[128];
  const int i = blockIdx.x * 128 + threadIdx.x;
  const float4 me = bodies[i];
  float ax = 0, ay = 0, az = 0;
  for (int base = 0; base < n; base += 128) {
    tile[threadIdx.x] = bodies[base + threadIdx.x];
    __syncthreads();
#pragma unroll 8
    for (int k = 0; k < 128; ++k) {
      const float dx = tile[k].x - me.x, dy = tile[k].y - me.y, dz = tile[k].z - me.z;
      const float r2 = dx * dx + dy * dy + dz * dz + 0.01f;
      const float inverse = rsqrtf(r2), w = tile[k].w * inverse * inverse * inverse;
      ax += w * dx; ay += w * dy; az += w * dz;
    }
    __syncthreads();
  }
  out[i] = make_float4(ax, ay, az, 0);
}

// Sorts 512 keys a block in shared memory.
extern "C" __global__ void h_bitonic(const unsigned* in, unsigned* out) {
  __shared__ unsigned s[512];
  const unsigned t = threadIdx.x, base = blockIdx.x * 512;
  s[t] = hash(in[base + t]);
  s[t + 256] = hash(in[base + t + 256]);
  for (unsigned k = 2; k <= 512; k *= 2)
    for (unsigned j = k / 2; j > 0; j /= 2) {
      __syncthreads();
      const unsigned a = 2 * t - (t & (j - 1)), b = a + j;
      const bool up = (a & k) == 0;
      const unsigned x = s[a], y = s[b];
      if ((x > y) == up) { s[a] = y; s[b] = x; }
    }
  __syncthreads();
  out[base + t] = s[t];
  out[base + t + 256] = s[t + 256];
}

// C = A * B for n x n, four by four results a thread, tiles of 64 x 16 in shared memory.
extern "C" __global__ void h_gemm(const float* a, const float* b, float* c, int n) {
  __shared__ float sa[16][64], sb[16][64];
  const int tx = threadIdx.x & 15, ty = threadIdx.x >> 4, row = blockIdx.y * 64, col = blockIdx.x * 64;
  float sum[4][4] = {};
  for (int k0 = 0; k0 < n; k0 += 16) {
    for (int i = threadIdx.x; i < 1024; i += 256) {
      sa[i & 15][i >> 4] = a[(row + (i >> 4)) * n + k0 + (i & 15)];
      sb[i >> 6][i & 63] = b[(k0 + (i >> 6)) * n + col + (i & 63)];
    }
    __syncthreads();
#pragma unroll
    for (int k = 0; k < 16; ++k)
#pragma unroll
      for (int i = 0; i < 4; ++i)
#pragma unroll
        for (int j = 0; j < 4; ++j) sum[i][j] += sa[k][ty * 4 + i] * sb[k][tx * 4 + j];
    __syncthreads();
  }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) c[(row + ty * 4 + i) * n + col + tx * 4 + j] = sum[i][j];
}

// Sums by shuffles, one atomic a warp on 64 words.
extern "C" __global__ void h_warp_sum(const float* in, float* out, int n) {
  float sum = 0;
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) sum += in[i];
  for (int d = 16; d > 0; d /= 2) sum += __shfl_xor_sync(~0u, sum, d);
  if ((threadIdx.x & 31) == 0) atomicAdd(&out[(blockIdx.x * 8 + threadIdx.x / 32) & 63], sum);
}

// Each thread follows 1 to 32 hashed links.
extern "C" __global__ void h_chase(const unsigned* table, unsigned* out, unsigned mask) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned at = i & mask;
  const unsigned steps = 1 + (hash(i) & 31);
  for (unsigned k = 0; k < steps; ++k) at = hash(table[at] + k) & mask;
  out[i] = at;
}

// Steps of 3n + 1 to 1: integers, lanes part.
extern "C" __global__ void h_collatz(unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned n = i + 1, steps = 0;
  while (n != 1) {
    n = n & 1 ? 3 * n + 1 : n >> 1;
    ++steps;
  }
  out[i] = steps;
}

// Prices of options: logarithms, exponentials, roots, quotients.
extern "C" __global__ void h_options(const float* in, float* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n) return;
  const float s = 5 + 25 * (in[i] / n), k = 1 + 99 * (hash(i) * 2.3283064e-10f), t = 0.25f + 9.75f * (hash(i + n) * 2.3283064e-10f);
  const float r = 0.02f, v = 0.3f, root = sqrtf(t);
  const float d1 = (logf(s / k) + (r + 0.5f * v * v) * t) / (v * root), d2 = d1 - v * root;
  const auto cnd = [](float d) {
    const float q = 1 / (1 + 0.2316419f * fabsf(d));
    const float p = 0.39894228f * expf(-0.5f * d * d) * (q * (0.31938153f + q * (-0.356563782f + q * (1.781477937f + q * (-1.821255978f + q * 1.330274429f)))));
    return d > 0 ? 1 - p : p;
  };
  out[i] = s * cnd(d1) - k * expf(-r * t) * cnd(d2);
}

// Newton's steps in double precision.
extern "C" __global__ void h_newton(const float* in, double* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n) return;
  const double a = 1 + in[i];
  double x = a;
  for (int k = 0; k < 8; ++k) x = x - (x * x * x - a) / (3 * x * x);
  out[i] = x;
}

// Rows of 1,024 to mean 0 and variance 1.
extern "C" __global__ void h_layer_norm(const float* in, float* out) {
  __shared__ float part[8];
  const float* row = in + blockIdx.x * 1024;
  float x[4], sum = 0;
  for (int k = 0; k < 4; ++k) sum += x[k] = row[threadIdx.x + 256 * k];
  for (int pass = 0; pass < 2; ++pass) {
    for (int d = 16; d > 0; d /= 2) sum += __shfl_xor_sync(~0u, sum, d);
    if ((threadIdx.x & 31) == 0) part[threadIdx.x / 32] = sum;
    __syncthreads();
    float all = 0;
    for (int w = 0; w < 8; ++w) all += part[w];
    __syncthreads();
    if (pass == 0) {
      sum = 0;
      for (int k = 0; k < 4; ++k) { x[k] -= all / 1024; sum += x[k] * x[k]; }
    } else {
      const float scale = rsqrtf(all / 1024 + 1e-5f);
      for (int k = 0; k < 4; ++k) out[blockIdx.x * 1024 + threadIdx.x + 256 * k] = x[k] * scale;
    }
  }
}

// Copies n vectors of four floats.
extern "C" __global__ void h_copy(const float4* in, float4* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n) out[i] = in[i];
}

// Counts hashed keys in 65,536 words of global memory.
extern "C" __global__ void h_count(const unsigned* in, unsigned* out, int n) {
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) atomicAdd(&out[hash(in[i]) & 65535], 1u);
}

// A heat equation's step in three dimensions, z in registers.
extern "C" __global__ void h_heat(const float* in, float* out, int n) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  if (x < 1 || y < 1 || x >= n - 1 || y >= n - 1) return;
  float below = in[y * n + x], here = in[(n + y) * n + x];
  for (int z = 1; z < n - 1; ++z) {
    const float above = in[((z + 1) * n + y) * n + x];
    const float* at = in + (z * n + y) * n + x;
    out[(z * n + y) * n + x] = here + 0.1f * (at[-1] + at[1] + at[-n] + at[n] + below + above - 6 * here);
    below = here;
    here = above;
  }
}

#ifndef KERNELS_ONLY
#include <cstdio>
#include <vector>
static float* floats(size_t n) { std::vector<float> h(n); for (size_t i = 0; i < n; ++i) h[i] = float(i); float* p; cudaMalloc(&p, n * 4); cudaMemcpy(p, h.data(), n * 4, cudaMemcpyHostToDevice); return p; }
static unsigned* words(size_t n) { std::vector<unsigned> h(n); for (size_t i = 0; i < n; ++i) h[i] = unsigned(i); unsigned* p; cudaMalloc(&p, n * 4); cudaMemcpy(p, h.data(), n * 4, cudaMemcpyHostToDevice); return p; }
static void* zeros(size_t bytes) { void* p; cudaMalloc(&p, bytes); cudaMemset(p, 0, bytes); return p; }
int main() {
  const int n = 1 << 18;
  float *f = floats(1 << 20), *o = (float*)zeros(64 << 20), *big = floats(16 << 20);
  unsigned *u = words(1 << 20);
  for (int turn = 0; turn < 3; ++turn) {
    h_scan<<<1024, 256>>>(f, o, n);
    h_spmv<<<256, 256>>>(big, f, o, 65536, 0xfffff);
    h_nbody<<<32, 128>>>((float4*)f, (float4*)o, 4096);
    h_bitonic<<<512, 256>>>(u, (unsigned*)o);
    h_gemm<<<dim3(8, 8), 256>>>(f, big, o, 512);
    h_warp_sum<<<264, 256>>>(big, o, 1 << 22);
    h_chase<<<512, 128>>>(u, (unsigned*)o, 0xfffff);
    h_collatz<<<512, 128>>>((unsigned*)o);
    h_options<<<1024, 256>>>(f, o, n);
    h_newton<<<256, 256>>>(f, (double*)o, 65536);
    h_layer_norm<<<1024, 256>>>(big, o);
    h_copy<<<16384, 256>>>((float4*)big, (float4*)o, 4 << 20);
    h_count<<<264, 256>>>(u, (unsigned*)o, 1 << 20);
    h_heat<<<dim3(4, 16), dim3(32, 8)>>>(big, o, 128);
  }
  printf("%s\n", cudaGetErrorString(cudaDeviceSynchronize()));
}
#endif
