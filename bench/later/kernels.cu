// Kernels that were written while the rules and the preset of November 27, 2026 (second half) were made, and compared once after these. Inputs count up
// (0, 1, 2 ...).
// SPDX-License-Identifier: Apache-2.0

// Sums of rows of a sparse matrix in CSR form, a warp for each row.
extern "C" __global__ void l_sparse_rows(const int* columns, const float* values, const float* x, float* y, int rows) {
  const int row = (blockIdx.x * blockDim.x + threadIdx.x) >> 5, lane = threadIdx.x & 31;
  if (row >= rows) return;
  const int begin = row * 40 + (row & 7), end = begin + 33 + (row % 5);
  float sum = 0;
  for (int k = begin + lane; k < end; k += 32) sum += values[k] * x[(columns[k] * 37) & 0xffff];
  for (int d = 16; d > 0; d >>= 1) sum += __shfl_down_sync(~0u, sum, d);
  if (lane == 0) y[row] = sum;
}
// Bitonic sort of blocks of 256 keys in shared memory.
extern "C" __global__ void l_bitonic(const unsigned* in, unsigned* out) {
  __shared__ unsigned s[256];
  const unsigned t = threadIdx.x, i = blockIdx.x * 256 + t;
  s[t] = in[i] * 2654435761u;
  __syncthreads();
  for (unsigned k = 2; k <= 256; k <<= 1)
    for (unsigned j = k >> 1; j > 0; j >>= 1) {
      const unsigned other = t ^ j;
      if (other > t) {
        const unsigned a = s[t], b = s[other];
        if (((t & k) == 0) == (a > b)) { s[t] = b; s[other] = a; }
      }
      __syncthreads();
    }
  out[i] = s[t];
}
// Inclusive sums of blocks, by shuffles and one array of warp sums.
extern "C" __global__ void l_block_scan(const int* in, int* out) {
  __shared__ int sums[32];
  const int i = blockIdx.x * blockDim.x + threadIdx.x, lane = threadIdx.x & 31, warp = threadIdx.x >> 5;
  int v = in[i];
  for (int d = 1; d < 32; d <<= 1) { const int o = __shfl_up_sync(~0u, v, d); if (lane >= d) v += o; }
  if (lane == 31) sums[warp] = v;
  __syncthreads();
  if (warp == 0) {
    int s = lane < (int)(blockDim.x >> 5) ? sums[lane] : 0;
    for (int d = 1; d < 32; d <<= 1) { const int o = __shfl_up_sync(~0u, s, d); if (lane >= d) s += o; }
    sums[lane] = s;
  }
  __syncthreads();
  out[i] = v + (warp > 0 ? sums[warp - 1] : 0);
}
// A histogram of bytes, with atomics of a block in shared memory.
extern "C" __global__ void l_byte_histogram(const uchar4* in, unsigned* out, int n) {
  __shared__ unsigned bins[256];
  for (int b = threadIdx.x; b < 256; b += blockDim.x) bins[b] = 0;
  __syncthreads();
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) {
    const uchar4 v = in[i];
    atomicAdd(&bins[v.x], 1u); atomicAdd(&bins[v.y], 1u); atomicAdd(&bins[v.z], 1u); atomicAdd(&bins[v.w], 1u);
  }
  __syncthreads();
  for (int b = threadIdx.x; b < 256; b += blockDim.x) atomicAdd(&out[b], bins[b]);
}
// FNV-1a hashes of strings of 16 bytes.
extern "C" __global__ void l_string_hash(const unsigned char* in, unsigned* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned h = 2166136261u;
  for (int k = 0; k < 16; ++k) { h ^= in[i * 16 + k]; h *= 16777619u; }
  out[i] = h;
}
// Powers modulo a prime, by squaring.
extern "C" __global__ void l_modular_power(const unsigned* in, unsigned* out, unsigned modulus) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned long long base = in[i] % modulus, result = 1;
  for (unsigned e = 65537; e; e >>= 1) { if (e & 1) result = result * base % modulus; base = base * base % modulus; }
  out[i] = (unsigned)result;
}
// Median of nine pixels, by a network of minima and maxima.
__device__ void order(float& a, float& b) { const float t = fminf(a, b); b = fmaxf(a, b); a = t; }
extern "C" __global__ void l_median9(const float* in, float* out, int width, int height) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  if (x < 1 || y < 1 || x >= width - 1 || y >= height - 1) return;
  float v[9];
  for (int k = 0; k < 9; ++k) v[k] = in[(y + k / 3 - 1) * width + x + k % 3 - 1];
  order(v[1], v[2]); order(v[4], v[5]); order(v[7], v[8]); order(v[0], v[1]); order(v[3], v[4]); order(v[6], v[7]);
  order(v[1], v[2]); order(v[4], v[5]); order(v[7], v[8]); order(v[0], v[3]); order(v[5], v[8]); order(v[4], v[7]);
  order(v[3], v[6]); order(v[1], v[4]); order(v[2], v[5]); order(v[4], v[7]); order(v[4], v[2]); order(v[6], v[4]); order(v[4], v[2]);
  out[y * width + x] = v[4];
}
// Distances of points to segments.
extern "C" __global__ void l_segments(const float4* segments, const float2* points, float* out, int count) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float2 p = points[i];
  float nearest = 1e30f;
  for (int s = 0; s < count; ++s) {
    const float4 g = segments[s];
    const float dx = g.z - g.x, dy = g.w - g.y, px = p.x - g.x, py = p.y - g.y;
    const float t = fminf(fmaxf((px * dx + py * dy) / (dx * dx + dy * dy), 0.0f), 1.0f);
    const float ex = px - t * dx, ey = py - t * dy;
    nearest = fminf(nearest, ex * ex + ey * ey);
  }
  out[i] = sqrtf(nearest);
}
// A step of the Game of Life on bits, 32 cells a word.
extern "C" __global__ void l_life_bits(const unsigned* in, unsigned* out, int words, int rows) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y;
  if (x >= words) return;
  unsigned ones = 0, twos = 0, fours = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    const unsigned* row = in + ((y + dy + rows) % rows) * words;
    const unsigned left = row[(x + words - 1) % words], here = row[x], right = row[(x + 1) % words];
    const unsigned west = here << 1 | left >> 31, east = here >> 1 | right << 31;
    unsigned carry = ones & west; ones ^= west; fours |= twos & carry; twos ^= carry;
    carry = ones & east; ones ^= east; fours |= twos & carry; twos ^= carry;
    if (dy != 0) { carry = ones & here; ones ^= here; fours |= twos & carry; twos ^= carry; }
  }
  out[y * words + x] = twos & ~fours & (ones | in[y * words + x]);
}
// Forces of a chain of springs, a few steps in registers with shuffles.
extern "C" __global__ void l_springs(const float* in, float* out, int steps) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  float x = in[i] * 0.01f, v = 0;
  for (int k = 0; k < steps; ++k) {
    const float left = __shfl_up_sync(~0u, x, 1), right = __shfl_down_sync(~0u, x, 1);
    v = 0.99f * v + 0.1f * (left - 2 * x + right);
    x += 0.05f * v;
  }
  out[i] = x;
}
// Transforms of 8 numbers by a matrix of cosines (a DCT) in both directions of tiles of 8x8.
extern "C" __global__ void l_cosines(const float* in, float* out, int width) {
  __shared__ float tile[8][9], half[8][9];
  const int u = threadIdx.x, v = threadIdx.y, at = (blockIdx.y * 8 + v) * width + blockIdx.x * 8 + u;
  tile[v][u] = in[at];
  __syncthreads();
  float sum = 0;
  for (int k = 0; k < 8; ++k) sum += tile[v][k] * cosf((2 * k + 1) * u * 0.19634954f);
  half[v][u] = sum;
  __syncthreads();
  sum = 0;
  for (int k = 0; k < 8; ++k) sum += half[k][u] * cosf((2 * k + 1) * v * 0.19634954f);
  out[at] = sum * 0.25f;
}
// Colours from YUV to RGB, four pixels of bytes for each thread.
extern "C" __global__ void l_colours(const uchar4* luma, const uchar4* u, const uchar4* v, uchar4* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const uchar4 a = luma[i], b = u[i], c = v[i];
  const int y[4] = {a.x, a.y, a.z, a.w}, d[4] = {b.x - 128, b.y - 128, b.z - 128, b.w - 128}, e[4] = {c.x - 128, c.y - 128, c.z - 128, c.w - 128};
  for (int k = 0; k < 4; ++k) {
    const int r = (298 * (y[k] - 16) + 409 * e[k] + 128) >> 8, g = (298 * (y[k] - 16) - 100 * d[k] - 208 * e[k] + 128) >> 8,
              w = (298 * (y[k] - 16) + 516 * d[k] + 128) >> 8;
    out[i * 4 + k] = make_uchar4(min(max(r, 0), 255), min(max(g, 0), 255), min(max(w, 0), 255), 255);
  }
}
// A search for the longest run of ones in words.
extern "C" __global__ void l_longest_run(const unsigned* in, int* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned x = in[i] * 0x9e3779b9u;
  int n = 0;
  while (x) { x &= x << 1; ++n; }
  out[i] = n;
}
// Probabilities of a normal distribution, and their inverse by three steps of Newton.
extern "C" __global__ void l_normal(const float* in, float* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float target = 0.01f + in[i] * 3.7e-6f;
  float x = 0;
  for (int k = 0; k < 3; ++k) {
    const float p = 0.5f * erfcf(-x * 0.70710678f), d = 0.39894228f * __expf(-0.5f * x * x);
    x -= (p - target) / d;
  }
  out[i] = x;
}
// A gather of neighbours in a hash grid, with a linear search of the bucket.
extern "C" __global__ void l_hash_grid(const int* keys, const int* table, int* out, int mask) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x, key = keys[i];
  unsigned slot = (key * 0x85ebca6bu >> 7) & mask;
  int found = -1;
  for (int probe = 0; probe < 8; ++probe) {
    const int k = table[slot];
    if ((k & 15) == (key & 15)) { found = (int)slot; break; }
    slot = (slot + 1) & mask;
  }
  out[i] = found;
}
// Sums of columns by a grid that strides, in doubles.
extern "C" __global__ void l_double_sums(const double* in, double* out, int n) {
  __shared__ double s[128];
  double sum = 0;
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) sum += in[i] * in[i];
  s[threadIdx.x] = sum;
  __syncthreads();
  for (int d = 64; d > 0; d >>= 1) { if (threadIdx.x < d) s[threadIdx.x] += s[threadIdx.x + d]; __syncthreads(); }
  if (threadIdx.x == 0) out[blockIdx.x] = s[0];
}
// Tiles of a product of matrices, four results for each thread.
extern "C" __global__ void l_tiles4(const float* a, const float* b, float* c, int n) {
  __shared__ float s[16][64], t[16][17];
  const int x = threadIdx.x, y = threadIdx.y, column = blockIdx.x * 64 + x, row = blockIdx.y * 16 + y;
  float sums[4] = {0, 0, 0, 0};
  for (int k = 0; k < n; k += 16) {
    for (int q = 0; q < 4; ++q) s[y][x + 16 * q] = b[(k + y) * n + column + 16 * q];
    t[y][x] = a[row * n + k + x];
    __syncthreads();
    for (int j = 0; j < 16; ++j)
      for (int q = 0; q < 4; ++q) sums[q] += t[y][j] * s[j][x + 16 * q];
    __syncthreads();
  }
  for (int q = 0; q < 4; ++q) c[row * n + column + 16 * q] = sums[q];
}
// Zones of points by a tree of decisions in an array.
extern "C" __global__ void l_decisions(const float2* points, const int2* nodes, int* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float2 p = points[i];
  int at = 1;
  while (at < 1024) {
    const int2 node = nodes[at];
    const float limit = (float)((node.y * 2654435761u >> 12) & 0x3ffff);
    at = at * 2 + ((at & 1 ? p.x : p.y) > limit);
  }
  out[i] = at - 1024;
}
// Packs flags of numbers into a queue, with one atomic of a block.
extern "C" __global__ void l_compact(const int* in, int* out, int* length) {
  __shared__ int base, counts[8];
  const int i = blockIdx.x * blockDim.x + threadIdx.x, lane = threadIdx.x & 31, warp = threadIdx.x >> 5;
  const int v = in[i];
  const bool keep = v % 3 == 1;
  const unsigned votes = __ballot_sync(~0u, keep);
  if (lane == 0) counts[warp] = __popc(votes);
  __syncthreads();
  if (threadIdx.x == 0) {
    int sum = 0;
    for (int w = 0; w < 8; ++w) { const int c = counts[w]; counts[w] = sum; sum += c; }
    base = atomicAdd(length, sum);
  }
  __syncthreads();
  if (keep) out[base + counts[warp] + __popc(votes & ((1u << lane) - 1))] = v;
}
// Rotations of bodies: products of quaternions, normalised.
extern "C" __global__ void l_quaternions(const float4* in, float4* out, int steps) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float4 w = in[i];
  float4 q = make_float4(0, 0, 0, 1);
  for (int k = 0; k < steps; ++k) {
    float4 r;
    r.x = q.w * w.x + q.x * w.w + q.y * w.z - q.z * w.y;
    r.y = q.w * w.y - q.x * w.z + q.y * w.w + q.z * w.x;
    r.z = q.w * w.z + q.x * w.y - q.y * w.x + q.z * w.w;
    r.w = q.w * w.w - q.x * w.x - q.y * w.y - q.z * w.z;
    const float s = rsqrtf(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
    q = make_float4(r.x * s, r.y * s, r.z * s, r.w * s);
  }
  out[i] = q;
}
