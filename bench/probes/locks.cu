// Times lanes of a warp that wait for other lanes of the same warp in a loop, on a real GPU.
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90 -O3 locks.cu -o locks && ./locks > locks.csv
// `lanes` lanes of each of `warps` warps of a block take a lock in turn, or wait for a flag of another lane. The cycles are those from the first begin to
// the last end in the block, the least of five launches. In "behind" the lanes hold the lock behind the loop that asks for it, in "inside" they hold it
// within the loop; "flag" has lanes that wait for a flag which lane 0 sets on the other path, behind 100 dependent multiplications. A row without a lock
// ("none") is what counting alone takes. The kernel ends only if the lanes that wait let the others go on.
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <vector>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ void count(int* words) {
  volatile int* const counter = words + 64;
  __threadfence();
  *counter = *counter + 1;
  __threadfence();
}
template <int KIND> __global__ void locks(int lanes, int* words, long long* begins, long long* ends) {
  const int lane = threadIdx.x & 31;
  __syncthreads();
  const long long begin = clock64();
  if (lane < lanes) {
    if (KIND == 0) {
      count(words);
    } else if (KIND == 1) {
      while (atomicCAS(words, 0, 1) != 0) {
      }
      count(words);
      atomicExch(words, 0);
    } else if (KIND == 2) {
      for (bool done = false; !done;) {
        if (atomicCAS(words, 0, 1) == 0) {
          count(words);
          atomicExch(words, 0);
          done = true;
        }
      }
    } else if (lane == 0) {
      unsigned x = threadIdx.x;
#pragma unroll 1
      for (int i = 0; i < 100; ++i) x = x * 1664525 + 1013904223;
      __threadfence();
      *(volatile int*)(words + 128 + threadIdx.x / 32) = x | 1;
    } else {
      while (*(volatile int*)(words + 128 + threadIdx.x / 32) == 0) {
      }
      __threadfence();
    }
  }
  const long long end = clock64();
  begins[threadIdx.x] = begin;
  ends[threadIdx.x] = end;
}
int main() {
  int* words;
  long long *begins, *ends;
  CHECK(cudaMalloc(&words, 1024));
  CHECK(cudaMalloc(&begins, 8192));
  CHECK(cudaMalloc(&ends, 8192));
  const char* names[] = {"none", "behind", "inside", "flag"};
  puts("kind,warps,lanes,counted,cycles");
  for (int kind = 0; kind < 4; ++kind)
    for (int warps : {1, 2, 4, 8})
      for (int lanes : {1, 2, 4, 8, 16, 32}) {
        long long best = 1ll << 60;
        int counted = 0;
        for (int r = 0; r < 5; ++r) {
          CHECK(cudaMemset(words, 0, 1024));
          if (kind == 0) locks<0><<<1, 32 * warps>>>(lanes, words, begins, ends);
          if (kind == 1) locks<1><<<1, 32 * warps>>>(lanes, words, begins, ends);
          if (kind == 2) locks<2><<<1, 32 * warps>>>(lanes, words, begins, ends);
          if (kind == 3) locks<3><<<1, 32 * warps>>>(lanes, words, begins, ends);
          std::vector<long long> first(32 * warps), last(32 * warps);
          CHECK(cudaMemcpy(first.data(), begins, 8 * first.size(), cudaMemcpyDeviceToHost));
          CHECK(cudaMemcpy(last.data(), ends, 8 * last.size(), cudaMemcpyDeviceToHost));
          CHECK(cudaMemcpy(&counted, words + 64, 4, cudaMemcpyDeviceToHost));
          best = std::min(best, *std::max_element(last.begin(), last.end()) - *std::min_element(first.begin(), first.end()));
        }
        printf("%s,%d,%d,%d,%lld\n", names[kind], warps, lanes, counted, best);
      }
}
