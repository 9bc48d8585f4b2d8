// Measures the cycles of asynchronous copies to shared memory and of barriers there, in one warp or two.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
#include <cstdio>

// Each kernel times `TIMED` after `BEFORE`, in a warp whose lanes have the global address `from`, the shared
// address `to` and a zero that the compiler does not know. A barrier for a million arrivals is at `bar`, and one
// for each lane at `own`.
#define PROBE(NAME, BEFORE, TIMED)                                                                           \
  __global__ void NAME(const char* data, const unsigned* zeros, long long* out) {                            \
    __shared__ __align__(16) char s[8192];                                                                   \
    const unsigned lane = threadIdx.x, base = (unsigned)__cvta_generic_to_shared(s), zero = zeros[lane];     \
    const unsigned bar = base + 4096, own = base + 4608 + 8 * lane, to = base + 16 * lane;                   \
    const char* const from = data + 16 * lane;                                                               \
    unsigned at = bar + zero;                                                                                \
    (void)own, (void)to, (void)from;                                                                         \
    if (lane == 0) asm volatile("mbarrier.init.shared.b64 [%0], 1000000;" ::"r"(bar) : "memory");            \
    asm volatile("mbarrier.init.shared.b64 [%0], 1000000;" ::"r"(own) : "memory");                           \
    BEFORE;                                                                                                  \
    *(volatile unsigned*)(s + 8000) = at; /* waits for what was loaded */                                    \
    __syncthreads();                                                                                         \
    __threadfence_block();                                                                                   \
    const unsigned begin = clock();                                                                          \
    TIMED;                                                                                                   \
    const unsigned end = clock();                                                                            \
    if (lane == 0) out[0] = end - begin, out[1] = at;                                                        \
  }
#define COPY(KIND, BYTES, OFFSET) \
  asm volatile("cp.async." #KIND ".shared.global [%0], [%1], " #BYTES ";" ::"r"(to), "l"(from + OFFSET) : "memory")
#define COMMIT asm volatile("cp.async.commit_group;" ::: "memory")
#define WAIT(N) asm volatile("cp.async.wait_group " #N ";" ::: "memory")
#define LOAD(KIND) asm volatile("ld.global." #KIND ".u32 %0, [%1];" : "=r"(x) : "l"(from) : "memory"); at += x & zero
#define TIMES_16(X) X X X X X X X X X X X X X X X X
#define ARRIVE                                                                                     \
  {                                                                                                \
    unsigned long long state;                                                                      \
    asm volatile("mbarrier.arrive.shared.b64 %0, [%1];" : "=l"(state) : "r"(at) : "memory");       \
    at += (unsigned)state & zero;                                                                  \
  }
#define ASK(KIND, PARITY)                                                                                     \
  {                                                                                                           \
    unsigned yes;                                                                                             \
    asm volatile("{ .reg .pred p; mbarrier." #KIND ".parity.shared.b64 p, [%1], %2; selp.u32 %0, 1, 0, p; }"  \
                 : "=r"(yes) : "r"(at), "r"(PARITY + zero) : "memory");                                       \
    at += yes & zero;                                                                                         \
  }

PROBE(nothing, , )
PROBE(wait_for_nothing, , COMMIT; WAIT(0))
PROBE(copy_4_from_l1, unsigned x; LOAD(ca), COPY(ca, 4, 0); COMMIT; WAIT(0))
PROBE(copy_16_from_l1, unsigned x; LOAD(ca), COPY(ca, 16, 0); COMMIT; WAIT(0))
PROBE(copy_16_from_l2, unsigned x; LOAD(cg), COPY(cg, 16, 0); COMMIT; WAIT(0))
PROBE(fence_behind_a_copy, unsigned x; LOAD(cg), COPY(cg, 16, 0); __threadfence_block())
PROBE(groups_wait_0, , COPY(cg, 16, 4096); COMMIT; COPY(cg, 16, 8192); COMMIT; COPY(cg, 16, 12288); COMMIT; WAIT(0))
PROBE(groups_wait_2, , COPY(cg, 16, 4096); COMMIT; COPY(cg, 16, 8192); COMMIT; COPY(cg, 16, 12288); COMMIT; WAIT(2))
PROBE(groups_wait_3, , COPY(cg, 16, 4096); COMMIT; COPY(cg, 16, 8192); COMMIT; COPY(cg, 16, 12288); COMMIT; WAIT(3))
PROBE(arrivals_16, , TIMES_16(ARRIVE))
PROBE(arrivals_16_apart, at = own + zero, TIMES_16(ARRIVE))
PROBE(loads_16, , TIMES_16({ unsigned x; asm volatile("ld.volatile.shared.u32 %0, [%1];" : "=r"(x) : "r"(at) : "memory"); at += x & zero; }))
PROBE(test_wait_16_true, , TIMES_16(ASK(test_wait, 1)))
PROBE(try_wait_16_true, , TIMES_16(ASK(try_wait, 1)))
PROBE(try_wait_false, , ASK(try_wait, 0) ASK(try_wait, 0) ASK(try_wait, 0) ASK(try_wait, 0))

// Warp 1 waits in try_wait or test_wait, and warp 0 arrives some 2,000 cycles later. The time runs from the clock
// before the arrival to that behind the wait.
template <bool TRY>
__global__ void wake(const char*, const unsigned* zeros, long long* out) {
  __shared__ __align__(8) unsigned long long barrier;
  __shared__ unsigned begin;
  const unsigned at = (unsigned)__cvta_generic_to_shared(&barrier) + zeros[threadIdx.x];
  if (threadIdx.x == 0) asm volatile("mbarrier.init.shared.b64 [%0], 1;" ::"r"(at) : "memory");
  __syncthreads();
  unsigned end = 0;
  if (threadIdx.x == 0) {
    const unsigned start = clock();
    while (clock() - start < 2000) {}
    unsigned now;
    asm volatile("mov.u32 %0, %clock; mbarrier.arrive.shared.b64 _, [%1];" : "=r"(now) : "r"(at) : "memory");
    begin = now;
  } else if (threadIdx.x == 32) {
    if (TRY)
      asm volatile("{ .reg .pred p; L: mbarrier.try_wait.parity.shared.b64 p, [%1], 0; @!p bra L; mov.u32 %0, %clock; }"
                   : "=r"(end) : "r"(at) : "memory");
    else
      asm volatile("{ .reg .pred p; L: mbarrier.test_wait.parity.shared.b64 p, [%1], 0; @!p bra L; mov.u32 %0, %clock; }"
                   : "=r"(end) : "r"(at) : "memory");
  }
  __syncthreads();
  if (threadIdx.x == 32) out[0] = end - begin;
}

using Kernel = void (*)(const char*, const unsigned*, long long*);
static void run(const char* name, Kernel kernel, int threads = 32) {
  char* data;
  unsigned* zeros;
  long long *out, cycles = 0;
  cudaMalloc(&data, 1 << 20), cudaMalloc(&zeros, 4096), cudaMalloc(&out, 64);
  cudaMemset(data, 0, 1 << 20), cudaMemset(zeros, 0, 4096);
  for (int i = 0; i < 3; ++i) kernel<<<1, threads>>>(data, zeros, out);
  cudaMemcpy(&cycles, out, 8, cudaMemcpyDeviceToHost);
  printf("%s,%lld\n", name, cycles);
  cudaFree(data), cudaFree(zeros), cudaFree(out);
}
#define RUN(NAME) run(#NAME, NAME)
int main() {
  printf("probe,cycles\n");
  RUN(nothing), RUN(wait_for_nothing), RUN(copy_4_from_l1), RUN(copy_16_from_l1), RUN(copy_16_from_l2);
  RUN(fence_behind_a_copy), RUN(groups_wait_0), RUN(groups_wait_2), RUN(groups_wait_3);
  RUN(arrivals_16), RUN(arrivals_16_apart), RUN(loads_16), RUN(test_wait_16_true), RUN(try_wait_16_true);
  RUN(try_wait_false);
  run("wake_from_try_wait", wake<true>, 64), run("wake_from_test_wait", wake<false>, 64);
  return cudaDeviceSynchronize() != cudaSuccess;
}
