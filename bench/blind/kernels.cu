// Kernels that were recorded after the last changes of the preset h200 and of the PTX front end, and compared once. Inputs count up (0, 1, 2 ...).
// SPDX-License-Identifier: Apache-2.0

// Soft maximum of rows of 256 numbers, a block each.
extern "C" __global__ void b_soft_maximum(const float* in, float* out) {
  __shared__ float s[256];
  const int t = threadIdx.x, i = blockIdx.x * 256 + t;
  const float x = in[i] * 1e-5f;
  s[t] = x;
  __syncthreads();
  for (int d = 128; d > 0; d >>= 1) { if (t < d) s[t] = fmaxf(s[t], s[t + d]); __syncthreads(); }
  const float most = s[0];
  __syncthreads();
  const float e = __expf(x - most);
  s[t] = e;
  __syncthreads();
  for (int d = 128; d > 0; d >>= 1) { if (t < d) s[t] += s[t + d]; __syncthreads(); }
  out[i] = e / s[0];
}
// A filter of 3x3 weights over a picture of floats.
extern "C" __global__ void b_filter3(const float* in, const float* weights, float* out, int width, int height) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  if (x >= width || y >= height) return;
  float sum = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int xx = x + dx, yy = y + dy;
      if (xx >= 0 && xx < width && yy >= 0 && yy < height) sum += in[yy * width + xx] * weights[(dy + 1) * 3 + dx + 1];
    }
  out[y * width + x] = sum;
}
// A random walk with xorshift numbers.
extern "C" __global__ void b_walk(int* out, int steps) {
  unsigned s = blockIdx.x * blockDim.x + threadIdx.x + 88172645u;
  int x = 0, y = 0;
  for (int k = 0; k < steps; ++k) {
    s ^= s << 13; s ^= s >> 17; s ^= s << 5;
    switch (s & 3) { case 0: ++x; break; case 1: --x; break; case 2: ++y; break; default: --y; }
  }
  out[blockIdx.x * blockDim.x + threadIdx.x] = x * x + y * y;
}
// Lower bounds of keys in a sorted array.
extern "C" __global__ void b_lower_bound(const int* sorted, const int* keys, int* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x, key = keys[i] * 7;
  int first = 0, count = n;
  while (count > 0) { const int half = count / 2; if (sorted[first + half] < key) { first += half + 1; count -= half + 1; } else count = half; }
  out[i] = first;
}
// A step of heat in a grid of three dimensions.
extern "C" __global__ void b_heat3(const float* in, float* out, int n) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 4 + threadIdx.y;
  if (x == 0 || y == 0 || x >= n - 1 || y >= n - 1) return;
  float below = in[y * n + x], here = in[(n + y) * n + x];
  for (int z = 1; z < 15; ++z) {
    const int i = (z * n + y) * n + x;
    const float above = in[i + n * n];
    out[i] = here + 0.1f * (in[i - 1] + in[i + 1] + in[i - n] + in[i + n] + below + above - 6 * here);
    below = here; here = above;
  }
}
// Prices of options by a binomial tree in shared memory.
extern "C" __global__ void b_binomial(const float* strikes, float* out) {
  __shared__ float v[129];
  const int t = threadIdx.x;
  const float strike = 90 + strikes[blockIdx.x] * 0.01f;
  v[t] = fmaxf(100 * __expf((2 * t - 128) * 0.02f) - strike, 0.0f);
  __syncthreads();
  for (int step = 127; step > 0; --step) {
    float next = 0;
    if (t < step) next = 0.999f * (0.51f * v[t + 1] + 0.49f * v[t]);
    __syncthreads();
    if (t < step) v[t] = next;
    __syncthreads();
  }
  if (t == 0) out[blockIdx.x] = v[0];
}
// Run lengths: where a row of small numbers changes, by ballots.
extern "C" __global__ void b_changes(const unsigned* in, unsigned* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const unsigned v = i < n ? in[i] / 5 % 3 : 9, before = __shfl_up_sync(~0u, v, 1);
  const unsigned mask = __ballot_sync(~0u, (threadIdx.x & 31) == 0 || v != before);
  if ((threadIdx.x & 31) == 0) out[i >> 5] = __popc(mask) | __clz(mask) << 8 | __ffs(mask) << 16;
}
// Products of small matrices, 4x4 for each thread.
extern "C" __global__ void b_small_products(const float4* a, const float4* b, float4* c) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  float4 rows[4];
  for (int k = 0; k < 4; ++k) rows[k] = b[i * 4 + k];
  for (int r = 0; r < 4; ++r) {
    const float4 v = a[i * 4 + r];
    c[i * 4 + r] = make_float4(v.x * rows[0].x + v.y * rows[1].x + v.z * rows[2].x + v.w * rows[3].x,
                               v.x * rows[0].y + v.y * rows[1].y + v.z * rows[2].y + v.w * rows[3].y,
                               v.x * rows[0].z + v.y * rows[1].z + v.z * rows[2].z + v.w * rows[3].z,
                               v.x * rows[0].w + v.y * rows[1].w + v.z * rows[2].w + v.w * rows[3].w);
  }
}
// Counts of letters in words, with a table in shared memory and atomics.
extern "C" __global__ void b_letters(const unsigned* in, unsigned* out) {
  __shared__ unsigned counts[64];
  if (threadIdx.x < 64) counts[threadIdx.x] = 0;
  __syncthreads();
  for (int k = 0; k < 4; ++k) {
    const unsigned w = in[(blockIdx.x * 4 + k) * blockDim.x + threadIdx.x] * 2654435761u;
    atomicAdd(&counts[w >> 26], 1u);
    atomicAdd(&counts[w >> 10 & 63], 1u);
  }
  __syncthreads();
  if (threadIdx.x < 64) atomicAdd(&out[threadIdx.x], counts[threadIdx.x]);
}
// Distances of words by edits, a word of eight letters for each thread.
extern "C" __global__ void b_edits(const unsigned* words, unsigned* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const unsigned a = words[i] * 0x9e3779b9u, b = words[i ^ 1] * 0x85ebca6bu;
  unsigned char row[9];
  for (int k = 0; k <= 8; ++k) row[k] = k;
  for (int r = 0; r < 8; ++r) {
    unsigned diagonal = r, left = r + 1;
    const unsigned letter = a >> (4 * r) & 3;
    for (int c = 0; c < 8; ++c) {
      const unsigned above = row[c + 1], same = (b >> (4 * c) & 3) == letter ? 0 : 1;
      unsigned least = diagonal + same;
      if (above + 1 < least) least = above + 1;
      if (left + 1 < least) least = left + 1;
      diagonal = above; row[c] = left; left = least;
    }
    row[8] = left;
  }
  out[i] = row[8];
}
// Roots of cubic polynomials by Halley's method, in double precision.
extern "C" __global__ void b_cubes(const float* in, float* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const double a = 1 + in[i] * 0.25;
  double x = 1 + a * 0.1;
  for (int k = 0; k < 6; ++k) { const double c = x * x * x; x = x * (c + 2 * a) / (2 * c + a); }
  out[i] = float(x);
}
// A ray's way through a grid of cells.
extern "C" __global__ void b_grid_rays(const unsigned* cells, float* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  float dx = 1 + (i & 63) * 0.01f, dy = 1 + (i >> 6 & 63) * 0.02f;
  int x = i % n, y = i / n % n;
  const float tx = 1 / dx, ty = 1 / dy;
  float nx = tx * 0.5f, ny = ty * 0.5f, t = 0;
  for (int k = 0; k < 64; ++k) {
    if (cells[y * n + x] % 17 == 3) break;
    if (nx < ny) { t = nx; nx += tx; if (++x == n) break; } else { t = ny; ny += ty; if (++y == n) break; }
  }
  out[i] = t;
}
// Mean and variance of columns.
extern "C" __global__ void b_columns(const float* in, float* out, int rows, int columns) {
  const int c = blockIdx.x * blockDim.x + threadIdx.x;
  float mean = 0, squares = 0;
  for (int r = 0; r < rows; ++r) {
    const float x = in[r * columns + c] * 1e-3f, d = x - mean;
    mean += d / (r + 1);
    squares += d * (x - mean);
  }
  out[c] = mean;
  out[columns + c] = squares / (rows - 1);
}
// Nibbles of words as a permutation, with a table of constants.
__constant__ unsigned char kBox[16] = {12, 5, 6, 11, 9, 0, 10, 13, 3, 14, 15, 8, 4, 7, 1, 2};
extern "C" __global__ void b_cipher(const unsigned* in, unsigned* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned v = in[i], key = 0x2b7e1516u;
  for (int round = 0; round < 8; ++round) {
    v ^= key;
    unsigned w = 0;
    for (int n = 0; n < 8; ++n) w |= unsigned(kBox[v >> (4 * n) & 15]) << (4 * n);
    v = (w << 7 | w >> 25) ^ (w << 18 | w >> 14) ^ w;
    key = key * 5 + round;
  }
  out[i] = v;
}
// Sums of a row of neighbours in shared memory, a window of 33.
extern "C" __global__ void b_window(const float* in, float* out, int n) {
  __shared__ float s[256 + 32];
  const int t = threadIdx.x, i = blockIdx.x * 256 + t;
  s[t] = in[i];
  if (t < 32) s[256 + t] = in[(i + 256) & (n - 1)];
  __syncthreads();
  float sum = 0;
  for (int k = 0; k <= 32; ++k) sum += s[t + k];
  out[i] = sum * (1 / 33.0f);
}
// Sorted quadruples, by compare and exchange in registers.
extern "C" __global__ void b_quadruples(const uint4* in, uint4* out) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  uint4 v = in[i];
  v.x *= 2654435761u; v.y *= 2246822519u; v.z *= 3266489917u; v.w *= 668265263u;
  unsigned t;
  if (v.x > v.y) { t = v.x; v.x = v.y; v.y = t; }
  if (v.z > v.w) { t = v.z; v.z = v.w; v.w = t; }
  if (v.x > v.z) { t = v.x; v.x = v.z; v.z = t; }
  if (v.y > v.w) { t = v.y; v.y = v.w; v.w = t; }
  if (v.y > v.z) { t = v.y; v.y = v.z; v.z = t; }
  out[i] = v;
}
// Sines and cosines summed to a wave.
extern "C" __global__ void b_wave(const float* in, float* out, int harmonics) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float x = in[i] * 1e-4f;
  float sum = 0;
  for (int k = 1; k <= harmonics; ++k) sum += __sinf(k * x) / k + 0.1f * __cosf((2 * k - 1) * x);
  out[i] = sum;
}
// Levels of a tree: parents by links, counted until the root.
extern "C" __global__ void b_levels(const unsigned* parents, unsigned* out, int n) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned node = i, level = 0;
  while (node != 0 && level < 40) { node = parents[node] / 3; ++level; }
  out[i] = level;
}
// Bilinear samples of a turned picture.
extern "C" __global__ void b_turned(const float* in, float* out, int width, float s, float c) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  const float u = c * x - s * y + width * 0.25f, v = s * x + c * y + width * 0.125f;
  const int x0 = int(floorf(u)), y0 = int(floorf(v)), x1 = min(max(x0, 0), width - 2), y1 = min(max(y0, 0), width - 2);
  const float fx = u - x0, fy = v - y0, *p = in + y1 * width + x1;
  out[y * width + x] = (p[0] * (1 - fx) + p[1] * fx) * (1 - fy) + (p[width] * (1 - fx) + p[width + 1] * fx) * fy;
}
// Triangles of a mesh: areas of faces whose corners are gathered.
extern "C" __global__ void b_areas(const float* corners, const int* faces, float* out, int mask) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  float p[3][3];
  for (int k = 0; k < 3; ++k) {
    const int v = (faces[i * 3 + k] * 97) & mask;
    for (int d = 0; d < 3; ++d) p[k][d] = corners[v * 3 + d] * 1e-3f;
  }
  const float ux = p[1][0] - p[0][0], uy = p[1][1] - p[0][1], uz = p[1][2] - p[0][2];
  const float vx = p[2][0] - p[0][0], vy = p[2][1] - p[0][1], vz = p[2][2] - p[0][2];
  const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  out[i] = 0.5f * sqrtf(nx * nx + ny * ny + nz * nz);
}
