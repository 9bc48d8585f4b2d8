// Kernels that were recorded before the last changes of the preset h200, and compared only after it was frozen. Inputs count up (0, 1, 2 ...).
// SPDX-License-Identifier: Apache-2.0

__device__ __forceinline__ unsigned hash(unsigned x) {
  x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16;
  return x;
}

// A checksum by a table of 256 words in shared memory.
extern "C" __global__ void n_checksum(const unsigned* in, unsigned* out) {
  __shared__ unsigned table[256];
  unsigned c = threadIdx.x;
  for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
  table[threadIdx.x] = c;
  __syncthreads();
  const unsigned i = blockIdx.x * 256 + threadIdx.x;
  unsigned sum = ~0u;
  for (int k = 0; k < 8; ++k) {
    unsigned w = in[(i + k * 256) & 0xfffff];
    for (int b = 0; b < 4; ++b) { sum = table[(sum ^ w) & 255] ^ (sum >> 8); w >>= 8; }
  }
  out[i] = ~sum;
}
// Areas by random points.
extern "C" __global__ void n_random_points(unsigned* inside, int points) {
  unsigned long long state = blockIdx.x * blockDim.x + threadIdx.x + 1;
  unsigned hits = 0;
  for (int k = 0; k < points; ++k) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    const unsigned shifted = unsigned(((state >> 18) ^ state) >> 27), turn = unsigned(state >> 59), r = (shifted >> turn) | (shifted << ((32 - turn) & 31));
    const float x = (r & 0xffff) * (1 / 65536.0f), y = (r >> 16) * (1 / 65536.0f);
    hits += x * x + y * y < 1;
  }
  inside[blockIdx.x * blockDim.x + threadIdx.x] = hits;
}
// Gradients of a picture of bytes.
extern "C" __global__ void n_gradients(const unsigned char* in, unsigned char* out, int width, int height) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  if (x < 1 || y < 1 || x >= width - 1 || y >= height - 1) return;
  const unsigned char* at = in + y * width + x;
  const int gx = at[1 - width] + 2 * at[1] + at[1 + width] - at[-1 - width] - 2 * at[-1] - at[width - 1];
  const int gy = at[width - 1] + 2 * at[width] + at[width + 1] - at[-width - 1] - 2 * at[-width] - at[1 - width];
  const int g = abs(gx) + abs(gy);
  out[y * width + x] = g > 255 ? 255 : g;
}
// A smoothing filter whose weights come from differences.
extern "C" __global__ void n_bilateral(const float* in, float* out, int width) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  const float here = in[y * width + x];
  float sum = 0, weights = 0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx) {
      const int xx = min(max(x + dx, 0), width - 1), yy = min(max(y + dy, 0), width - 1);
      const float v = in[yy * width + xx], d = (v - here) * 1e-3f, w = __expf(-(dx * dx + dy * dy) * 0.2f - d * d);
      sum += w * v; weights += w;
    }
  out[y * width + x] = sum / weights;
}
// One step of all shortest paths.
extern "C" __global__ void n_shortest(int* paths, int n, int k) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  const int through = paths[y * n + k] + paths[k * n + x];
  if (through < paths[y * n + x]) paths[y * n + x] = through;
}
// The nearest of 32 centres in four dimensions.
extern "C" __global__ void n_nearest(const float4* points, const float4* centres, int* out) {
  __shared__ float4 c[32];
  if (threadIdx.x < 32) c[threadIdx.x] = centres[threadIdx.x * 1024];
  __syncthreads();
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float4 p = points[i];
  float least = 3e38f;
  int best = 0;
  for (int k = 0; k < 32; ++k) {
    const float dx = p.x - c[k].x, dy = p.y - c[k].y, dz = p.z - c[k].z, dw = p.w - c[k].w, d = dx * dx + dy * dy + dz * dz + dw * dw;
    if (d < least) { least = d; best = k; }
  }
  out[i] = best;
}
// Greatest common divisors.
extern "C" __global__ void n_divisor(unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned a = hash(i) | 1, b = hash(i + 77777) | 1;
  while (b) { const unsigned r = a % b; a = b; b = r; }
  out[i] = a;
}
// Counts of bits in words, and places of the first.
extern "C" __global__ void n_bits(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned sum = 0;
  for (int k = 0; k < 16; ++k) { const unsigned v = hash(in[(i + k * 4096) & 0xfffff]); sum += __popc(v) * 3 + __clz(v) + __ffs(v) + (__brev(v) & 15); }
  out[i] = sum;
}
// Counts of four bits of keys a warp, by votes.
extern "C" __global__ void n_digits(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x, lane = threadIdx.x & 31, d = hash(in[i]) & 15;
  unsigned count = 0;
  for (unsigned v = 0; v < 16; ++v) { const unsigned m = __ballot_sync(~0u, d == v); if (lane == v) count = __popc(m); }
  if (lane < 16) out[(i >> 5) * 16 + lane] = count;
}
// Rows and columns of pairs turned in blocks of 16x16, scaled.
extern "C" __global__ void n_turn(const float2* in, float2* out, int n) {
  __shared__ float2 s[16][17];
  const int x = blockIdx.x * 16 + threadIdx.x, y = blockIdx.y * 16 + threadIdx.y;
  s[threadIdx.y][threadIdx.x] = in[y * n + x];
  __syncthreads();
  const float2 v = s[threadIdx.x][threadIdx.y];
  out[(blockIdx.x * 16 + threadIdx.y) * n + blockIdx.y * 16 + threadIdx.x] = make_float2(v.x * 0.5f, v.y * 0.25f);
}
// A fractal in double precision.
extern "C" __global__ void n_julia(unsigned* out, int width) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  double a = 3.0 * x / width - 1.5, b = 2.0 * y / width - 1.0;
  int k = 0;
  for (; k < 64 && a * a + b * b < 4; ++k) { const double t = a * a - b * b - 0.7; b = 2 * a * b + 0.27; a = t; }
  out[y * width + x] = k;
}
// Small matrices by Gauss's elimination, one a warp's quarter in shared memory.
extern "C" __global__ void n_eliminate(const float* in, float* out) {
  __shared__ float m[8][8][9];
  const int g = threadIdx.x / 8, c = threadIdx.x & 7, base = (blockIdx.x * 8 + g) * 64;
  for (int r = 0; r < 8; ++r) m[g][r][c] = float(hash(int(in[base + r * 8 + c])) & 255) + (r == c ? 512.0f : 0.0f);
  __syncwarp();
  for (int p = 0; p < 7; ++p) {
    const float pivot = m[g][p][c], inverse = 1 / m[g][p][p];
    __syncwarp();
    for (int r = p + 1; r < 8; ++r) {
      const float f = m[g][r][p] * inverse;
      __syncwarp();
      m[g][r][c] -= f * pivot;
      __syncwarp();
    }
  }
  for (int r = 0; r < 8; ++r) out[base + r * 8 + c] = m[g][r][c];
}
// Rays against 24 spheres, the nearest hit.
extern "C" __global__ void n_spheres(float* out, int width) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  const float dx = (x - width / 2) / float(width), dy = (y - width / 2) / float(width), l = rsqrtf(dx * dx + dy * dy + 1);
  float nearest = 1e9f;
  for (int k = 0; k < 24; ++k) {
    const unsigned h = hash(k);
    const float cx = (h & 255) / 128.0f - 1, cy = ((h >> 8) & 255) / 128.0f - 1, cz = 2 + ((h >> 16) & 255) / 64.0f;
    const float b = (dx * cx + dy * cy + cz) * l, c = cx * cx + cy * cy + cz * cz - 0.09f, d = b * b - c;
    if (d > 0) { const float t = b - sqrtf(d); if (t > 0 && t < nearest) nearest = t; }
  }
  out[y * width + x] = nearest < 1e9f ? 1 / nearest : 0;
}
// Grey values of coloured pixels, packed four a word.
extern "C" __global__ void n_grey(const uint4* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const uint4 p = in[i];
  const auto grey = [](unsigned c) { return ((c & 255) * 54 + ((c >> 8) & 255) * 183 + ((c >> 16) & 255) * 19) >> 8; };
  out[i] = grey(p.x) | grey(p.y) << 8 | grey(p.z) << 16 | grey(p.w) << 24;
}
// a + s * b with a stride of five words.
extern "C" __global__ void n_strided(const float* a, const float* b, float* c, float s) {
  const unsigned i = (blockIdx.x * blockDim.x + threadIdx.x) * 5;
  c[i] = a[i] + s * b[i];
}
// A knapsack's row: the best of two earlier sums.
extern "C" __global__ void n_knapsack(const int* before, int* now, int weight, int value, int n) {
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) {
    const int without = before[i], with = i >= weight ? before[i - weight] + value : 0;
    now[i] = max(without, with);
  }
}
// Two sorted lists merged: each thread finds its place by halving.
extern "C" __global__ void n_merge(const int* a, int* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x, v = a[i] * 2 + (i & 1);
  int low = 0, high = n;
  while (low < high) { const int middle = (low + high) >> 1; if (a[middle] * 3 < v) low = middle + 1; else high = middle; }
  out[i] = low;
}
// Sums of a grid's four neighbours, in four sweeps a launch through shared memory.
extern "C" __global__ void n_relax(const float* in, float* out, int n) {
  __shared__ float s[2][18][34];
  const int tx = threadIdx.x, ty = threadIdx.y, x = blockIdx.x * 32 + tx, y = blockIdx.y * 16 + ty;
  s[0][ty + 1][tx + 1] = s[1][ty + 1][tx + 1] = in[y * n + x];
  if (tx < 2) s[0][ty + 1][tx * 33] = s[1][ty + 1][tx * 33] = 0;
  if (ty < 2) s[0][ty * 17][tx + 1] = s[1][ty * 17][tx + 1] = 0;
  __syncthreads();
  for (int k = 0; k < 4; ++k) {
    const auto& f = s[k & 1];
    s[1 - (k & 1)][ty + 1][tx + 1] = 0.25f * (f[ty][tx + 1] + f[ty + 2][tx + 1] + f[ty + 1][tx] + f[ty + 1][tx + 2]);
    __syncthreads();
  }
  out[y * n + x] = s[0][ty + 1][tx + 1];
}
// Words counted by their lengths: bytes, branches, atomics on few words.
extern "C" __global__ void n_words(const unsigned char* text, unsigned* counts, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i == 0 || i >= n) return;
  const bool begins = (hash(text[i] + i) & 7) != 0 && (hash(text[i - 1] + i - 1) & 7) == 0;
  if (!begins) return;
  int length = 0;
  while (length < 15 && (hash(text[i + length] + i + length) & 7) != 0) ++length;
  atomicAdd(&counts[length], 1u);
}
// Small sorts in registers and local memory: the median of nine hashed values.
extern "C" __global__ void n_median(const float* in, float* out, int mask) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  float v[9];
  for (int k = 0; k < 9; ++k) v[k] = float(hash(int(in[(i + k * 37) & mask])) & 1023);
  for (int a = 0; a < 5; ++a)
    for (int b = a + 1; b < 9; ++b) if (v[b] < v[a]) { const float t = v[a]; v[a] = v[b]; v[b] = t; }
  out[i] = v[4];
}
