// Times products of matrices and the moves of matrices between shared memory and registers, on a real GPU (probes/README.md).
// SPDX-License-Identifier: Apache-2.0
//
// nvcc -arch=sm_90a -O3 tensor.cu -o tensor && ./tensor > tensor.csv
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#define CHECK(x) do { cudaError_t e = (x); if (e) { printf("error %s line %d\n", cudaGetErrorString(e), __LINE__); exit(1); } } while (0)
__device__ __forceinline__ unsigned now() { unsigned t; asm volatile("mov.u32 %0, %%clock;" : "=r"(t) :: "memory"); return t; }

// An op of kC registers of sums. Its sources do not change, and its sums are a chain.
#define PRODUCT_4_4_2(NAME, OP) struct NAME { using T = unsigned; static constexpr const char* kName = OP; static constexpr int kC = 4; \
  static __device__ __forceinline__ void run(T* c, const T* a) { asm volatile(OP " {%0,%1,%2,%3}, {%4,%5,%6,%7}, {%8,%9}, {%0,%1,%2,%3};" \
    : "+r"(c[0]), "+r"(c[1]), "+r"(c[2]), "+r"(c[3]) : "r"(a[0]), "r"(a[1]), "r"(a[2]), "r"(a[3]), "r"(a[4]), "r"(a[5])); } };
#define PRODUCT_4_2_1(NAME, OP) struct NAME { using T = unsigned; static constexpr const char* kName = OP; static constexpr int kC = 4; \
  static __device__ __forceinline__ void run(T* c, const T* a) { asm volatile(OP " {%0,%1,%2,%3}, {%4,%5}, {%6}, {%0,%1,%2,%3};" \
    : "+r"(c[0]), "+r"(c[1]), "+r"(c[2]), "+r"(c[3]) : "r"(a[0]), "r"(a[1]), "r"(a[2])); } };
#define PRODUCT_2_4_2(NAME, OP) struct NAME { using T = unsigned; static constexpr const char* kName = OP; static constexpr int kC = 2; \
  static __device__ __forceinline__ void run(T* c, const T* a) { asm volatile(OP " {%0,%1}, {%2,%3,%4,%5}, {%6,%7}, {%0,%1};" \
    : "+r"(c[0]), "+r"(c[1]) : "r"(a[0]), "r"(a[1]), "r"(a[2]), "r"(a[3]), "r"(a[4]), "r"(a[5])); } };
#define PRODUCT_2_2_1(NAME, OP) struct NAME { using T = unsigned; static constexpr const char* kName = OP; static constexpr int kC = 2; \
  static __device__ __forceinline__ void run(T* c, const T* a) { asm volatile(OP " {%0,%1}, {%2,%3}, {%4}, {%0,%1};" \
    : "+r"(c[0]), "+r"(c[1]) : "r"(a[0]), "r"(a[1]), "r"(a[2])); } };
#define PRODUCT_2_1_1(NAME, OP) struct NAME { using T = unsigned; static constexpr const char* kName = OP; static constexpr int kC = 2; \
  static __device__ __forceinline__ void run(T* c, const T* a) { asm volatile(OP " {%0,%1}, {%2}, {%3}, {%0,%1};" \
    : "+r"(c[0]), "+r"(c[1]) : "r"(a[0]), "r"(a[1])); } };
PRODUCT_4_4_2(F16, "mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32")
PRODUCT_4_4_2(Bf16, "mma.sync.aligned.m16n8k16.row.col.f32.bf16.bf16.f32")
PRODUCT_2_4_2(F16Sums, "mma.sync.aligned.m16n8k16.row.col.f16.f16.f16.f16")
PRODUCT_4_2_1(F16Short, "mma.sync.aligned.m16n8k8.row.col.f32.f16.f16.f32")
PRODUCT_2_2_1(F16SumsShort, "mma.sync.aligned.m16n8k8.row.col.f16.f16.f16.f16")
PRODUCT_4_4_2(Tf32, "mma.sync.aligned.m16n8k8.row.col.f32.tf32.tf32.f32")
PRODUCT_4_2_1(Tf32Short, "mma.sync.aligned.m16n8k4.row.col.f32.tf32.tf32.f32")
PRODUCT_4_4_2(S8, "mma.sync.aligned.m16n8k32.row.col.s32.s8.s8.s32")
PRODUCT_4_4_2(S8Clamped, "mma.sync.aligned.m16n8k32.row.col.satfinite.s32.u8.s8.s32")
PRODUCT_4_2_1(S8Short, "mma.sync.aligned.m16n8k16.row.col.s32.s8.s8.s32")
PRODUCT_2_1_1(S8Small, "mma.sync.aligned.m8n8k16.row.col.s32.s8.s8.s32")
PRODUCT_4_4_2(S4, "mma.sync.aligned.m16n8k64.row.col.satfinite.s32.s4.s4.s32")
PRODUCT_4_2_1(S4Short, "mma.sync.aligned.m16n8k32.row.col.s32.s4.u4.s32")
PRODUCT_2_1_1(S4Small, "mma.sync.aligned.m8n8k32.row.col.s32.s4.s4.s32")
PRODUCT_4_4_2(And, "mma.sync.aligned.m16n8k256.row.col.s32.b1.b1.s32.and.popc")
PRODUCT_4_4_2(Xor, "mma.sync.aligned.m16n8k256.row.col.s32.b1.b1.s32.xor.popc")
PRODUCT_4_2_1(AndShort, "mma.sync.aligned.m16n8k128.row.col.s32.b1.b1.s32.and.popc")
PRODUCT_4_2_1(XorShort, "mma.sync.aligned.m16n8k128.row.col.s32.b1.b1.s32.xor.popc")
PRODUCT_2_1_1(AndSmall, "mma.sync.aligned.m8n8k128.row.col.s32.b1.b1.s32.and.popc")
PRODUCT_2_1_1(XorSmall, "mma.sync.aligned.m8n8k128.row.col.s32.b1.b1.s32.xor.popc")
struct F64 { using T = double; static constexpr const char* kName = "mma.sync.aligned.m8n8k4.row.col.f64.f64.f64.f64"; static constexpr int kC = 2;
  static __device__ __forceinline__ void run(T* c, const T* a) {
    asm volatile("mma.sync.aligned.m8n8k4.row.col.f64.f64.f64.f64 {%0,%1}, {%2}, {%3}, {%0,%1};" : "+d"(c[0]), "+d"(c[1]) : "d"(a[0]), "d"(a[1])); } };

constexpr int kSteps = 16, kTurns = 32;
// Each warp has kChains chains; the sums of all of them begin with other words, so that none is left out.
template <class Op, int kChains> __global__ void products(typename Op::T* data, unsigned* times) {
  typename Op::T a[6], c[kChains][Op::kC];
  for (int i = 0; i < 6; ++i) a[i] = data[threadIdx.x + 1024 * i];
  for (int j = 0; j < kChains; ++j) for (int i = 0; i < Op::kC; ++i) c[j][i] = data[threadIdx.x + 1024 * (6 + j * Op::kC + i)];
  __syncthreads();
  const unsigned t0 = now();
#pragma unroll 1
  for (int turn = 0; turn < kTurns; ++turn)
#pragma unroll
    for (int step = 0; step < kSteps; ++step) Op::run(c[step % kChains], a);
  for (int j = 0; j < kChains; ++j) for (int i = 0; i < Op::kC; ++i) data[threadIdx.x + 1024 * (6 + j * Op::kC + i)] = c[j][i];
  const unsigned t1 = now();
  times[2 * threadIdx.x] = t0;
  times[2 * threadIdx.x + 1] = t1;
}

// Moves of matrices, by their number and what is timed.
enum Move { Load1, Load2, Load4, Load4Transposed, Store1, Store2, Store4, Plain, Turn };
const char* const kMoves[] = {"ldmatrix.x1", "ldmatrix.x2", "ldmatrix.x4", "ldmatrix.x4.trans", "stmatrix.x1", "stmatrix.x2", "stmatrix.x4", "ld.shared.v4", "movmatrix"};
template <int kMove> __device__ __forceinline__ void move(unsigned* r, unsigned at) {
  if constexpr (kMove == Load1) asm volatile("ldmatrix.sync.aligned.m8n8.x1.shared.b16 {%0}, [%1];" : "=r"(r[0]) : "r"(at) : "memory");
  if constexpr (kMove == Load2) asm volatile("ldmatrix.sync.aligned.m8n8.x2.shared.b16 {%0,%1}, [%2];" : "=r"(r[0]), "=r"(r[1]) : "r"(at) : "memory");
  if constexpr (kMove == Load4) asm volatile("ldmatrix.sync.aligned.m8n8.x4.shared.b16 {%0,%1,%2,%3}, [%4];" : "=r"(r[0]), "=r"(r[1]), "=r"(r[2]), "=r"(r[3]) : "r"(at) : "memory");
  if constexpr (kMove == Load4Transposed) asm volatile("ldmatrix.sync.aligned.m8n8.x4.trans.shared.b16 {%0,%1,%2,%3}, [%4];" : "=r"(r[0]), "=r"(r[1]), "=r"(r[2]), "=r"(r[3]) : "r"(at) : "memory");
  if constexpr (kMove == Store1) asm volatile("stmatrix.sync.aligned.m8n8.x1.shared.b16 [%1], {%0};" :: "r"(r[0]), "r"(at) : "memory");
  if constexpr (kMove == Store2) asm volatile("stmatrix.sync.aligned.m8n8.x2.shared.b16 [%2], {%0,%1};" :: "r"(r[0]), "r"(r[1]), "r"(at) : "memory");
  if constexpr (kMove == Store4) asm volatile("stmatrix.sync.aligned.m8n8.x4.shared.b16 [%4], {%0,%1,%2,%3};" :: "r"(r[0]), "r"(r[1]), "r"(r[2]), "r"(r[3]), "r"(at) : "memory");
  if constexpr (kMove == Plain) asm volatile("ld.shared.v4.b32 {%0,%1,%2,%3}, [%4];" : "=r"(r[0]), "=r"(r[1]), "=r"(r[2]), "=r"(r[3]) : "r"(at) : "memory");
  if constexpr (kMove == Turn) asm volatile("movmatrix.sync.aligned.m8n8.trans.b16 %0, %0;" : "+r"(r[0]));
}
// With kChain, each address needs the result before it. `spread` is the distance of the rows of neighbouring lanes.
template <int kMove, bool kChain> __global__ void moves(unsigned* data, unsigned* times, unsigned spread) {
  __shared__ alignas(16) unsigned words[4096];
  for (int i = threadIdx.x; i < 4096; i += blockDim.x) words[i] = data[i];
  unsigned at = unsigned(__cvta_generic_to_shared(words)) + threadIdx.x % 32 * spread, r[4][4] = {}, sum = 0;
  __syncthreads();
  const unsigned t0 = now();
#pragma unroll 1
  for (int turn = 0; turn < kTurns; ++turn)
#pragma unroll
    for (int step = 0; step < kSteps; ++step) {
      move<kMove>(r[kChain ? 0 : step % 4], at + (kChain || kMove == Turn ? 0 : step * 512));
      if (kChain) at += r[0][0];
    }
  for (int j = 0; j < 4; ++j) for (int i = 0; i < 4; ++i) sum ^= r[j][i];
  data[threadIdx.x + 8192] = sum + at;
  const unsigned t1 = now();
  times[2 * threadIdx.x] = t0;
  times[2 * threadIdx.x + 1] = t1;
}

// Returns the cycles of a core from the first beginning to the last end, for each op of a warp: the least of three runs.
template <class Launch> double cycles(int warps, Launch launch) {
  static unsigned *times = nullptr, host[2048];
  if (!times) CHECK(cudaMalloc(&times, sizeof host));
  unsigned best = ~0u;
  for (int run = 0; run < 3; ++run) {
    launch(warps, times);
    CHECK(cudaDeviceSynchronize());
    CHECK(cudaMemcpy(host, times, sizeof host, cudaMemcpyDeviceToHost));
    unsigned first = host[0], last = host[1];
    for (int i = 0; i < 32 * warps; ++i) { first = std::min(first, host[2 * i]); last = std::max(last, host[2 * i + 1]); }
    best = std::min(best, last - first);
  }
  return best / double(kSteps * kTurns);
}
template <class Op> void time_product() {
  static typename Op::T* data = nullptr;
  if (!data) CHECK(cudaMalloc(&data, 1024 * 32 * sizeof *data));
  CHECK(cudaMemset(data, 0, 1024 * 32 * sizeof *data));
  const auto one = [&](int warps, unsigned* times) { products<Op, 1><<<1, 32 * warps>>>(data, times); };
  const auto four = [&](int warps, unsigned* times) { products<Op, 4><<<1, 32 * warps>>>(data, times); };
  printf("%s,%.2f,%.2f,%.2f\n", Op::kName, cycles(1, one), cycles(1, four), cycles(16, four) / 4);
}
template <int kMove> void time_move(unsigned spread) {
  static unsigned* data = nullptr;
  if (!data) CHECK(cudaMalloc(&data, 65536));
  CHECK(cudaMemset(data, 0, 65536));
  const auto chain = [&](int warps, unsigned* times) { moves<kMove, true><<<1, 32 * warps>>>(data, times, spread); };
  const auto flow = [&](int warps, unsigned* times) { moves<kMove, false><<<1, 32 * warps>>>(data, times, spread); };
  // The assembler drops loads whose registers are loaded again: of 16 without a chain 4 remain, and of ld.shared.v4 none.
  constexpr bool kLoads = kMove <= Load4Transposed, kStores = kMove >= Store1 && kMove <= Store4;
  constexpr double kDropped = kLoads ? 4 : 1;
  printf("%s rows %u bytes apart,", kMoves[kMove], spread);
  if (!kStores) printf("%.2f", cycles(1, chain));
  if (kMove == Plain) printf(",,\n");
  else printf(",%.2f,%.2f\n", cycles(1, flow) * kDropped, cycles(16, flow) / 16 * kDropped);
}
template <class... Ops> void time_products() { (time_product<Ops>(), ...); }
int main() {
  printf("op,cycles of a chain,cycles with 4 chains of one warp,cycles with 16 warps: of a scheduler for mma and of the core for moves\n");
  time_products<F16, Bf16, F16Sums, F16Short, F16SumsShort, Tf32, Tf32Short, F64, S8, S8Clamped, S8Short, S8Small, S4, S4Short, S4Small, And, Xor,
                AndShort, XorShort, AndSmall, XorSmall>();
  time_move<Load1>(16); time_move<Load2>(16); time_move<Load4>(16); time_move<Load4Transposed>(16); time_move<Load4>(128);
  time_move<Store1>(16); time_move<Store2>(16); time_move<Store4>(16); time_move<Plain>(16); time_move<Turn>(16);
}
