// Kernels that each show one thing that the hardware's assembler or memory does. Inputs count up (0, 1, 2 ...); what looks random is hashed from them.
// SPDX-License-Identifier: Apache-2.0

__device__ __forceinline__ unsigned hash(unsigned x) {
  x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16;
  return x;
}
__device__ __forceinline__ unsigned rotate(unsigned x, int n) { return (x << n) | (x >> (32 - n)); }

// Integers: a hash of 16 words with rotations, products and exclusive ors.
extern "C" __global__ void p_mixing_hash(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned h = 0x9747b28cu;
#pragma unroll 4
  for (int k = 0; k < 16; ++k) {
    unsigned w = in[(i * 16 + k) & 0xfffff];
    w *= 0xcc9e2d51u; w = rotate(w, 15); w *= 0x1b873593u;
    h ^= w; h = rotate(h, 13); h = h * 5 + 0xe6546b64u;
  }
  h ^= 64; h ^= h >> 16; h *= 0x85ebca6bu; h ^= h >> 13; h *= 0xc2b2ae35u; h ^= h >> 16;
  out[i] = h;
}

// Integers: a hash of 64 bytes, one after another.
extern "C" __global__ void p_byte_hash(const unsigned char* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned h = 2166136261u;
  for (int k = 0; k < 64; ++k) h = (h ^ in[(i * 64 + k) & 0x3fffff]) * 16777619u;
  out[i] = h;
}

// Integers: rounds of a message digest, three-input logic.
extern "C" __global__ void p_digest(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned w[16], a = 0x6a09e667u, b = 0xbb67ae85u, c = 0x3c6ef372u, d = 0xa54ff53au, e = 0x510e527fu, f = 0x9b05688cu, g = 0x1f83d9abu, h = 0x5be0cd19u;
#pragma unroll
  for (int k = 0; k < 16; ++k) w[k] = in[(i + k * 64) & 0xfffff];
#pragma unroll
  for (int k = 0; k < 48; ++k) {
    if (k >= 16) {
      const unsigned x = w[(k - 15) & 15], y = w[(k - 2) & 15];
      w[k & 15] += (rotate(x, 25) ^ rotate(x, 14) ^ (x >> 3)) + w[(k - 7) & 15] + (rotate(y, 15) ^ rotate(y, 13) ^ (y >> 10));
    }
    const unsigned t = h + (rotate(e, 26) ^ rotate(e, 21) ^ rotate(e, 7)) + ((e & f) ^ (~e & g)) + (0x428a2f98u + k * 0x9e3779b9u) + w[k & 15];
    const unsigned u = (rotate(a, 30) ^ rotate(a, 19) ^ rotate(a, 10)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g; g = f; f = e; e = d + t; d = c; c = b; b = a; a = t + u;
  }
  out[i] = a ^ b ^ c ^ d ^ e ^ f ^ g ^ h;
}

// Integers: a filter of nine taps with clamped places.
extern "C" __global__ void p_filter(const int* in, int* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const int taps[9] = {1, -3, 7, 12, 20, 12, 7, -3, 1};
  int sum = 0;
#pragma unroll
  for (int k = -4; k <= 4; ++k) sum += taps[k + 4] * in[min(max(i + k, 0), n - 1)];
  out[i] = sum >> 4;
}

// Floats: five by five taps through shared memory.
extern "C" __global__ void p_blur(const float* in, const float* taps, float* out, int width) {
  __shared__ float tile[12][36];
  const int x0 = blockIdx.x * 32, y0 = blockIdx.y * 8;
  for (int t = threadIdx.y * 32 + threadIdx.x; t < 12 * 36; t += 256) {
    const int x = x0 + t % 36 - 2, y = y0 + t / 36 - 2;
    tile[t / 36][t % 36] = x >= 0 && y >= 0 && x < width && y < width ? in[y * width + x] : 0;
  }
  __syncthreads();
  float sum = 0;
  for (int dy = 0; dy < 5; ++dy)
    for (int dx = 0; dx < 5; ++dx) sum += taps[dy * 5 + dx] * tile[threadIdx.y + dy][threadIdx.x + dx];
  out[(y0 + threadIdx.y) * width + x0 + threadIdx.x] = sum;
}

// Remainders: modular powers with products of 64 bits.
extern "C" __global__ void p_power(const unsigned* in, unsigned* out, unsigned modulus) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned long long base = in[i] % modulus, result = 1;
  for (unsigned e = 65537 + (i & 7); e; e >>= 1) {
    if (e & 1) result = result * base % modulus;
    base = base * base % modulus;
  }
  out[i] = unsigned(result);
}

// Remainders of 32 bits: trial division.
extern "C" __global__ void p_divisors(unsigned* out, unsigned first) {
  const unsigned n = first + blockIdx.x * blockDim.x + threadIdx.x;
  unsigned found = 0;
  for (unsigned d = 2; d < 64; ++d) found += n % d == 0;
  out[n - first] = found;
}

// Remainders of 64 bits, whose divisor is a variable and large.
extern "C" __global__ void p_wide_remainder(const unsigned long long* in, unsigned long long* out, unsigned long long modulus) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned long long x = in[i] * 0x9e3779b97f4a7c15ull;
  for (int k = 0; k < 8; ++k) x = (x * 6364136223846793005ull + 1442695040888963407ull) % modulus;
  out[i] = x;
}

// Remainders by constants.
extern "C" __global__ void p_constant_remainder(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned x = in[i] + 12345;
  for (int k = 0; k < 16; ++k) x = (x * 48271u) % 2147483647u + x / 10 + (x % 1000);
  out[i] = x;
}

// Atomics: every thread adds 1 to one word, and reads nothing.
extern "C" __global__ void p_count_all(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  if (hash(in[i]) & 1) atomicAdd(out, 1u);
}
// Atomics: every thread adds a value of its own to one word.
extern "C" __global__ void p_sum_all(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  atomicAdd(out, hash(in[i]) & 255);
}
// Atomics: a queue whose places the threads get from one word.
extern "C" __global__ void p_queue(const unsigned* in, unsigned* out, unsigned* tail) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x, v = hash(in[i]);
  if ((v & 3) == 0) out[atomicAdd(tail, 1u) & 0xffff] = v;
}
// Atomics: floats on a few words; a maximum on one.
extern "C" __global__ void p_extremes(const float* in, float* out, int* most) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const float v = float(hash(i) & 1023) + in[i] * 0.0f;
  atomicAdd(&out[i & 15], v);
  atomicMax(most, int(v));
}
// Atomics in shared memory: a histogram of 64 bins.
extern "C" __global__ void p_bins(const unsigned* in, unsigned* out, int n) {
  __shared__ unsigned bins[64];
  if (threadIdx.x < 64) bins[threadIdx.x] = 0;
  __syncthreads();
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) atomicAdd(&bins[hash(in[i]) & 63], 1u);
  __syncthreads();
  if (threadIdx.x < 64) atomicAdd(&out[threadIdx.x], bins[threadIdx.x]);
}

// Contraction: sums and products of registers that a loop writes.
extern "C" __global__ void p_contracted(const float* in, float* out, int steps) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  float x = in[i] * 1e-6f, y = 0.3f, z = 0.1f;
  for (int k = 0; k < steps; ++k) {
    const float p = x * y;
    if (k & 1) z = p + z; else z = z - p;
    const float dx = 10 * (y - x), dy = x * (2.8f - z) - y, dz = x * y - 2.6f * z;
    x += dx * 0.01f; y += dy * 0.01f; z += dz * 0.01f;
  }
  out[i] = x + y + z;
}

// Quotients: numerators that are 0, denormal and normal.
extern "C" __global__ void p_quotients(const float* in, float* out, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const unsigned h = hash(i + k * n);
    const float a = (h & 3) == 0 ? 0.0f : (h & 63) == 1 ? 1e-41f : in[(h >> 8) & 0xffff];
    sum += a / (1.0f + in[i & 0xff] + k);
  }
  out[i] = sum;
}

// Local memory: sorts 24 values by insertion in an array of the thread.
extern "C" __global__ void p_insertion(const unsigned* in, unsigned* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned v[24];
  for (int k = 0; k < 24; ++k) {
    const unsigned x = hash(in[i] + k * 77) & 0xffff;
    int at = k;
    while (at > 0 && v[at - 1] > x) { v[at] = v[at - 1]; --at; }
    v[at] = x;
  }
  unsigned sum = 0;
  for (int k = 0; k < 24; ++k) sum = sum * 31 + v[k];
  out[i] = sum;
}

// Writes: one byte a thread.
extern "C" __global__ void p_bytes(const uchar4* in, unsigned char* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const uchar4 c = in[i];
  out[i] = (unsigned char)((c.x * 77 + c.y * 150 + c.z * 29) >> 8);
}
// Writes: four bytes of each sector.
extern "C" __global__ void p_strided_writes(const float* in, float* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  out[i * 8] = in[i] * 2;
}
// Writes: to hashed places.
extern "C" __global__ void p_scattered_writes(const float* in, float* out, unsigned mask) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  out[hash(i) & mask] = in[i];
}
// Writes: three successive stores of a thread to one sector (a structure of three floats).
extern "C" __global__ void p_triples(const float* in, float* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const float v = in[i];
  out[i * 3] = v; out[i * 3 + 1] = v * v; out[i * 3 + 2] = v + 1;
}
// Writes: eight successive stores of a thread to a line of its own.
extern "C" __global__ void p_records(const float* in, float* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const float v = in[i];
#pragma unroll
  for (int k = 0; k < 8; ++k) out[i * 8 + k] = v * k;
}

// DRAM: chains of dependent misses.
extern "C" __global__ void p_chain(const unsigned* in, unsigned* out, unsigned mask) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  unsigned at = hash(i) & mask;
  for (int k = 0; k < 16; ++k) at = (hash(in[at] + k)) & mask;
  out[i] = at;
}
// DRAM: a cold burst that reads everything once.
extern "C" __global__ void p_burst(const float4* in, float* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const float4 v = in[i];
  const float s = v.x + v.y + v.z + v.w;
  if (s < 0) out[i] = s;
}
// DRAM: a longer stream in a loop.
extern "C" __global__ void p_stream(const float4* in, float* out, int n) {
  float s = 0;
  for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) { const float4 v = in[i]; s += v.x + v.y + v.z + v.w; }
  out[blockIdx.x * blockDim.x + threadIdx.x] = s;
}

// Launch: one warp; many small blocks; nothing but the launch.
extern "C" __global__ void p_tiny(const float* in, float* out) { out[threadIdx.x] = in[threadIdx.x] + 1; }
extern "C" __global__ void p_nothing(float* out) { if (out == nullptr) *out = 0; }
extern "C" __global__ void p_many_blocks(float* out) { out[blockIdx.x * blockDim.x + threadIdx.x] = float(threadIdx.x); }
// Launch: long straight code that runs once (instruction cache).
extern "C" __global__ void p_straight(const float* in, float* out) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  float x = in[i], y = x + 1;
#pragma unroll
  for (int k = 0; k < 400; ++k) { x = x * 1.0001f + y; y = y * 0.999f - x * (0.001f * k + 0.5f); }
  out[i] = x + y;
}

// Schedule: many loads and chains a turn, registers against warps.
extern "C" __global__ void p_many_chains(const float* in, float* out, int turns, int stride) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  float a[16];
#pragma unroll
  for (int k = 0; k < 16; ++k) a[k] = k;
  for (int t = 0; t < turns; ++t)
#pragma unroll
    for (int k = 0; k < 16; ++k) { const float v = in[(i + (t * 16 + k) * stride) & 0xfffff]; a[k] = a[k] * v + sqrtf(v); }
  float s = 0;
#pragma unroll
  for (int k = 0; k < 16; ++k) s += a[k];
  out[i] = s;
}

// Bytes and bits: a cellular automaton of bytes; searching words in text.
extern "C" __global__ void p_life(const unsigned char* in, unsigned char* out, int width) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y;
  int sum = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (dx || dy) sum += in[((y + dy) & (width - 1)) * width + ((x + dx) & (width - 1))] & 1;
  out[y * width + x] = sum == 3 || (sum == 2 && (in[y * width + x] & 1));
}
extern "C" __global__ void p_search(const unsigned char* text, const unsigned char* word, int* out, int length) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  int matched = 0;
  while (matched < length && (text[i + matched] & 15) == (word[matched] & 15)) ++matched;
  if (matched == length) out[i >> 8] = i;
  else if (matched > 2) out[4096 + (i >> 8)] = matched;
}

// Dynamic programming along diagonals in shared memory.
extern "C" __global__ void p_diagonals(const unsigned char* a, const unsigned char* b, int* out) {
  __shared__ int row[3][130];
  const int t = threadIdx.x, base = blockIdx.x * 128;
  row[0][t] = row[1][t] = row[2][t] = t;
  __syncthreads();
  int now = 2, last = 1, before = 0;
  for (int d = 0; d < 255; ++d) {
    const int i = t, j = d - t;
    if (j >= 0 && j < 128) {
      const int cost = (a[base + i] & 7) == (b[base + j] & 3) ? 0 : 1;
      row[now][i + 1] = min(min(row[last][i] + 1, row[last][i + 1] + 1), row[before][i] + cost);
    }
    __syncthreads();
    const int old = before; before = last; last = now; now = old;
  }
  out[base + t] = row[last][t + 1];
}

// Fourier transform of 256 complex numbers in shared memory.
extern "C" __global__ void p_fourier(const float* in, float2* out) {
  __shared__ float2 s[256];
  const int t = threadIdx.x;
  for (int k = t; k < 256; k += 128) s[__brev(k) >> 24] = make_float2(in[blockIdx.x * 256 + k] * 1e-5f, 0);
  __syncthreads();
  for (int half = 1; half < 256; half *= 2) {
    const int k = t & (half - 1), a = ((t - k) << 1) + k, b = a + half;
    float sn, cs;
    sincosf(-3.14159265f * k / half, &sn, &cs);
    const float2 u = s[a], v = s[b], w = make_float2(v.x * cs - v.y * sn, v.x * sn + v.y * cs);
    s[a] = make_float2(u.x + w.x, u.y + w.y);
    s[b] = make_float2(u.x - w.x, u.y - w.y);
    __syncthreads();
  }
  for (int k = t; k < 256; k += 128) out[blockIdx.x * 256 + k] = s[k];
}

// Noise on a lattice: floors, hashes, interpolation.
extern "C" __global__ void p_noise(float* out, int width, float scale) {
  const int x = blockIdx.x * 32 + threadIdx.x, y = blockIdx.y * 8 + threadIdx.y;
  float sum = 0, amplitude = 1, fx = x * scale, fy = y * scale;
  for (int octave = 0; octave < 4; ++octave) {
    const float bx = floorf(fx), by = floorf(fy), u = fx - bx, v = fy - by;
    const int ix = int(bx), iy = int(by);
    const auto corner = [&](int dx, int dy) { return float(hash((ix + dx) * 73856093 ^ (iy + dy) * 19349663) & 0xffff) * (1.0f / 65536); };
    const float a = corner(0, 0), b = corner(1, 0), c = corner(0, 1), d = corner(1, 1), su = u * u * (3 - 2 * u), sv = v * v * (3 - 2 * v);
    sum += amplitude * (a + (b - a) * su + (c - a) * sv + (a - b - c + d) * su * sv);
    amplitude *= 0.5f; fx *= 2; fy *= 2;
  }
  out[y * width + x] = sum;
}

// A product of a matrix and a vector, a warp a row; its sum by shuffles.
extern "C" __global__ void p_matrix_vector(const float* m, const float* v, float* out, int n) {
  const int row = (blockIdx.x * blockDim.x + threadIdx.x) / 32, lane = threadIdx.x & 31;
  float s = 0;
  for (int k = lane; k < n; k += 32) s += m[row * n + k] * v[k];
  for (int d = 16; d > 0; d /= 2) s += __shfl_down_sync(~0u, s, d);
  if (lane == 0) out[row] = s;
}

// Sums of 64 bits and wide addresses.
extern "C" __global__ void p_wide_sums(const long long* in, long long* out, long long n, long long stride) {
  long long s = 0, most = -1;
  for (long long i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += stride) { const long long v = in[i]; s += v * 3 - (v >> 2); most = v > most ? v : most; }
  out[blockIdx.x * blockDim.x + threadIdx.x] = s ^ most;
}
