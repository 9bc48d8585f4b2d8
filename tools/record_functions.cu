// Records a GPU's approximate functions over octaves of floats. It prints the lines of kOctaves in
// tests/isa/approximate_test.cpp, with the same hashes.
//
// To run it: nvcc -O2 -o record tools/record_functions.cu && ./record
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <vector>

enum Function { Rcp, Rsqrt, Sqrt, Ex2, Lg2, Sin, Cos, Tanh };

template <Function kFunction>
__global__ void record(uint32_t first, uint32_t step, uint32_t count, uint32_t* out) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= count) return;
  const float x = __uint_as_float(first + i * step);
  float y;
  if constexpr (kFunction == Rcp) asm volatile("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Rsqrt) asm volatile("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Sqrt) asm volatile("sqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Ex2) asm volatile("ex2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Lg2) asm volatile("lg2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Sin) asm volatile("sin.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Cos) asm volatile("cos.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  if constexpr (kFunction == Tanh) asm volatile("tanh.approx.f32 %0, %1;" : "=f"(y) : "f"(x));
  out[i] = __float_as_uint(y);
}

template <Function kFunction>
void print_hash(const char* op, uint32_t first, uint32_t step = 1, uint32_t count = 1u << 23) {
  std::vector<uint32_t> words(count);
  uint32_t* device = nullptr;
  cudaMalloc(&device, count * sizeof(uint32_t));
  record<kFunction><<<(count + 255) / 256, 256>>>(first, step, count, device);
  const cudaError_t status = cudaMemcpy(words.data(), device, count * sizeof(uint32_t), cudaMemcpyDeviceToHost);
  cudaFree(device);
  uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, with words in place of bytes
  for (const uint32_t word : words) hash = (hash ^ word) * 0x100000001b3ull;
  if (status != cudaSuccess) std::printf("%s: %s\n", op, cudaGetErrorString(status));
  std::printf("{\"%s\", 0x%08x, %u, %u, 0x%016llx},\n", op, first, step, count, static_cast<unsigned long long>(hash));
}

int main() {
  constexpr uint32_t kSampled = 1u << 22;
  print_hash<Rcp>("rcp.approx.ftz.f32", 0x3f800000);
  for (uint32_t first : {0x3f000000u, 0x3f800000u}) print_hash<Rsqrt>("rsqrt.approx.ftz.f32", first);
  for (uint32_t first : {0x3f000000u, 0x3f800000u}) print_hash<Sqrt>("sqrt.approx.ftz.f32", first);
  print_hash<Ex2>("ex2.approx.ftz.f32", 0x3f800000);
  for (uint32_t first : {0x3f000000u, 0x3f800000u}) print_hash<Lg2>("lg2.approx.ftz.f32", first);
  for (uint32_t first : {0x3f800000u, 0x40000000u, 0x40800000u}) print_hash<Sin>("sin.approx.ftz.f32", first);
  print_hash<Cos>("cos.approx.ftz.f32", 0x40800000);
  for (uint32_t first : {0x3e000000u, 0x3e800000u, 0x3f000000u}) print_hash<Tanh>("tanh.approx.f32", first);
  for (uint32_t first : {0x30000000u, 0xb0000000u}) print_hash<Ex2>("ex2.approx.ftz.f32", first, 127, kSampled);
  print_hash<Sin>("sin.approx.ftz.f32", 0x30000000, 127, kSampled);
  print_hash<Tanh>("tanh.approx.f32", 0x30000000, 101, kSampled);
}
