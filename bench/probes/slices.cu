// Finds the L2 slice of each line of an array: two lines of one slice take twice as long together, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 slices.cu -o slices && ./slices 4096
// Slices are numbered as they are found.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
// Half of the warps add to line `a`, and the others to line `b`.
__global__ void pair(unsigned* p, unsigned a, unsigned b, unsigned* most) {
  unsigned* at = p + size_t(threadIdx.x / 32 & 1 ? a : b) * 32;
  const long long t0 = clock64();
  if ((threadIdx.x & 31) == 0)
    for (int k = 0; k < 6; ++k) asm volatile("red.global.add.u32 [%0], %1;" :: "l"(at), "r"(k + threadIdx.x) : "memory");
  __threadfence();
  __syncthreads();
  if (threadIdx.x == 0) atomicMax(most, unsigned(clock64() - t0));
}
int main(int argc, char** argv) {
  const int lines = argc > 1 ? atoi(argv[1]) : 4096;
  unsigned *p, *most; CHECK(cudaMalloc(&p, 64 << 20)); CHECK(cudaMemset(p, 0, 64 << 20)); CHECK(cudaMalloc(&most, 4096));
  printf("# %p\n", (void*)p);
  std::vector<int> refs; std::vector<int> slice(lines, -1);
  FILE* f = fopen("slices.csv", "w"); fputs("line,slice\n", f);
  unsigned h[256];
  for (int r = 0; r < 200; ++r) pair<<<132, 128>>>(p, 0, 1, most);
  for (int line = 0; line < lines; ++line) {
    const int n = int(refs.size());
    std::vector<unsigned> best(n, ~0u);
    for (int r = 0; r < 2 && n; ++r) {
      CHECK(cudaMemsetAsync(most, 0, 1024));
      for (int k = 0; k < n; ++k) pair<<<132, 128>>>(p, line, refs[k], most + k);
      CHECK(cudaMemcpy(h, most, 1024, cudaMemcpyDeviceToHost));
      for (int k = 0; k < n; ++k) best[k] = std::min(best[k], h[k]);
    }
    int at = n ? int(std::max_element(best.begin(), best.end()) - best.begin()) : 0;
    std::vector<unsigned> sorted(best); std::sort(sorted.begin(), sorted.end());
    const unsigned top = n ? sorted[n - 1] : 0, median = n > 1 ? sorted[(n - 1) / 2] : 3000;
    if (n == 0 || top < median * 1.4) { if (n < 200) { at = n; refs.push_back(line); } else at = -1; }
    slice[line] = at;
    fprintf(f, "%d,%d\n", line, at);
  }
  fclose(f);
  printf("slices %zu\n", refs.size());
}
