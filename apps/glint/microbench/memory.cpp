// Measures latencies and bandwidths of memory: pointer chases, conflicts, coalescing, streams, atomics.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <utility>

#include "apps/glint/microbench/kernel.h"
#include "base/diagnostics.h"

namespace glint::app {
namespace {

constexpr uint64_t kPlace = 1;  // marks a word that is a place in the buffer

// Returns a ring of places that are `stride` bytes apart. Their order is random and fixed: a generator of
// full period over a power of two gives it.
std::vector<uint64_t> ring(uint64_t bytes, uint64_t stride) {
  const uint64_t n = bytes / stride;
  std::vector<uint64_t> words(bytes / 8);
  for (uint64_t i = 0; i < n; ++i) words[i * stride / 8] = ((i * 5 + 3) % n) * stride | kPlace;
  return words;
}

// Returns the cycles of a load of one lane, each from the place that the last one gave. With `warm`, the ring
// was gone through once before.
double chase(uint64_t bytes, uint64_t stride, bool warm, const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.data = ring(bytes, stride);
  kernel.before = "mov.b64 %rd1,%rd0;\n";
  kernel.body = "ld.global.u64 %rd1,[%rd1];\n";
  kernel.after = "st.global.u64 [%rd0],%rd1;\n";
  kernel.unroll = 16;
  const auto turns = uint32_t(bytes / stride / kernel.unroll);
  const uint32_t lap = std::max(turns, 4u), half = std::min(lap / 2, 128u);
  return (warm ? cycles_per_turn(kernel, lap, lap + half, with_one_core(gpu))
               : cycles_per_turn(kernel, half / 2, half, with_one_core(gpu))) /
         kernel.unroll;
}

// Returns the cycles of a body in a chain of dependent instructions. The turn's own instructions are hidden
// behind the loads of the next turn, except for the last turn, and the chain never waits for them.
double chain(const std::string& before, const std::string& body, const std::string& after,
             const pipeline::GpuParams& gpu, const std::string& variables = {}, uint32_t threads = 32) {
  MicroKernel kernel;
  kernel.before = "mov.u32 %r1,%laneid;\n" + before;
  kernel.body = body;
  kernel.after = after;
  kernel.variables = variables;
  kernel.turns = 4;
  kernel.threads = threads;
  kernel.bytes = 1 << 18;
  return cycles_per_body(kernel, 16, 48, with_one_core(gpu));
}

constexpr const char* kShared = ".shared .align 16 .b8 room[32768];\n";

double shared_chase(uint32_t stride, const pipeline::GpuParams& gpu) {
  const std::string s = std::to_string(stride);
  return chain("mul.lo.u32 %r1,%r1," + s +
                   ";and.b32 %r1,%r1,16383;mov.u32 %r2,room;add.u32 %r1,%r1,%r2;\nst.shared.u32 "
                   "[%r1],%r1;\nbar.sync 0;\n",
               "ld.shared.u32 %r1,[%r1];\n", "st.global.u32 [%rd0],%r1;\n", gpu, kShared);
}

// Returns the cycles per load of a warp, when 32 warps do loads that do not depend on each other.
double shared_throughput(uint32_t stride, const std::string& width, const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.variables = kShared;
  kernel.threads = 1024;
  kernel.turns = 4;
  kernel.before = fmt::format(
      "mov.u32 %r1,%laneid;mul.lo.u32 %r1,%r1,{};and.b32 %r1,%r1,16383;mov.u32 %r2,room;add.u32 "
      "%r1,%r1,%r2;\n",
      stride);
  kernel.body = width == "v4"   ? "ld.shared.v4.u32 {%r4,%r5,%r6,%r7},[%r1];lop3.b32 %r8,%r8,%r4,%r7,0x96;\n"
                : width == "v2" ? "ld.shared.v2.u32 {%r4,%r5},[%r1];lop3.b32 %r8,%r8,%r4,%r5,0x96;\n"
                                : "ld.shared.u32 %r4,[%r1];xor.b32 %r8,%r8,%r4;\n";
  kernel.after = "st.global.u32 [%rd0],%r8;\n";
  return cycles_per_body(kernel, 8, 24, with_one_core(gpu)) / 32;
}

MicroKernel global_loads(uint32_t stride, const std::string& width) {
  MicroKernel kernel;
  kernel.bytes = 1 << 18;
  kernel.turns = 4;
  kernel.before = fmt::format("mov.u32 %r1,%laneid;mad.wide.u32 %rd1,%r1,{},%rd0;\n", stride);
  kernel.body = width == "v4"   ? "ld.global.v4.u32 {%r4,%r5,%r6,%r7},[%rd1];lop3.b32 %r8,%r8,%r4,%r7,0x96;\n"
                : width == "v2" ? "ld.global.v2.u32 {%r4,%r5},[%rd1];lop3.b32 %r8,%r8,%r4,%r5,0x96;\n"
                                : "ld.global.u32 %r4,[%rd1];xor.b32 %r8,%r8,%r4;\n";
  kernel.after = "st.global.u32 [%rd0],%r8;\n";
  return kernel;
}

double l1_throughput(uint32_t stride, const std::string& width, uint32_t warps,
                     const pipeline::GpuParams& gpu) {
  MicroKernel kernel = global_loads(stride, width);
  kernel.threads = warps * 32;
  return cycles_per_body(kernel, 8, 24, with_one_core(gpu)) / warps;
}

// Returns the latency of a load of all lanes. Each loads a place of its own that holds 0, and adds what it
// got to the address.
double l1_latency(uint32_t stride, const pipeline::GpuParams& gpu) {
  return chain(fmt::format("mad.wide.u32 %rd1,%r1,{},%rd0;\n", stride),
               "ld.global.u32 %r4,[%rd1];mad.wide.u32 %rd1,%r4,4,%rd1;\nadd.s64 %rd1,%rd1,0;\n",
               "st.global.u64 [%rd0],%rd1;\n", gpu);
}

// Puts the thread's number in the grid into %r1.
const std::string kThread =
    "mov.u32 %r1,%ctaid.x;mov.u32 %r2,%ntid.x;mov.u32 %r3,%tid.x;mad.lo.u32 %r1,%r1,%r2,%r3;\n";

constexpr uint32_t kLoads = 4;  // loads of 16 bytes that a thread does in a turn of a stream

// Returns the GB/s of all cores that read a buffer of `bytes`, from the cycles of a turn of the kernel. The
// body of the kernel adds `step` to %rd2 after each load, and the mask keeps %rd2 inside of the buffer.
double read_stream(MicroKernel kernel, uint64_t step, uint32_t few, uint32_t many,
                   const pipeline::GpuParams& gpu) {
  kernel.before += fmt::format("mov.u64 %rd3,{};\n", kernel.bytes - 1);
  kernel.body = fmt::format("and.b64 %rd4,%rd2,%rd3;add.s64 %rd4,%rd4,%rd0;add.s64 %rd2,%rd2,{};\n", step);
  kernel.body += "ld.global.v4.u32 {%r2#,%r3#,%r4#,%r5#},[%rd4];\n";
  kernel.unroll = kLoads;
  kernel.after =
      "xor.b32 %r4,%r20,%r21;xor.b32 %r5,%r22,%r23;xor.b32 %r4,%r4,%r5;setp.eq.u32 %p1,%r4,12345;@%p1 "
      "st.global.u32 [%rd0],%r4;\n";
  const double bytes = double(uint64_t{kernel.blocks} * kernel.threads * 16 * kLoads);
  return bytes / cycles_per_turn(kernel, few, many, gpu) * gpu.clock_mhz * 1e-3;
}

MicroKernel full_grid(const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.threads = full_block(gpu);
  kernel.blocks = gpu.cores * 2;
  return kernel;
}

// Returns the GB/s of all cores over `bytes` (a power of two), with each word read once.
double dram_stream(uint64_t bytes, const pipeline::GpuParams& gpu) {
  MicroKernel kernel = full_grid(gpu);
  kernel.bytes = bytes;
  // In turn t, load i of thread g reads word g of the part (t * loads + i) of the buffer. Each part is as
  // long as the grid.
  const uint64_t grid = uint64_t{kernel.blocks} * kernel.threads * 16;
  kernel.before = kThread + "mul.wide.u32 %rd2,%r1,16;\n";
  const auto turns = uint32_t(std::max<uint64_t>(bytes / (grid * kLoads) / 2, 1));
  return read_stream(kernel, grid, turns, turns * 2, gpu);
}

// Returns how many blocks' shares a block moves on after each load, so that a core comes back to a line as
// late as possible. `buffer` is the number of shares in the buffer, a power of two. An odd step visits all of
// them. `distance` becomes the loads of a block before its core, which has a second block `cores` shares
// further on, meets a share again.
uint64_t late_step(uint64_t cores, uint64_t buffer, uint64_t& distance) {
  uint64_t best = 1;
  distance = 0;
  for (uint64_t step = 2 * cores + 1; step < 2 * cores + 32; step += 2)
    for (uint64_t loads = 1; loads <= buffer; ++loads) {
      const uint64_t place = loads * step % buffer, other = cores % buffer;
      if (place != 0 && place != other && place != (buffer - other) % buffer) continue;
      if (loads > distance) distance = loads, best = step;
      break;
    }
  return best;
}

// Returns the GB/s of all cores over a buffer that lies in the L2 and in no L1.
double l2_stream(const pipeline::GpuParams& gpu) {
  constexpr uint64_t kMost = 8 << 20;  // bytes, as on the hardware that `--compare` is about
  const uint64_t l1 = gpu.memory.l1.size, l2 = gpu.memory.num_slices() * gpu.memory.l2.slice_size;
  MicroKernel kernel = full_grid(gpu);
  const uint64_t share = uint64_t{kernel.threads} * 16;
  kernel.bytes = std::min(kMost, std::bit_floor(l2 / 2));
  uint64_t distance = 0;
  const uint64_t step = late_step(gpu.cores, std::max<uint64_t>(kernel.bytes / share, 1), distance);
  if (kernel.bytes < share || 2 * distance * share < 2 * l1)
    throw UserError(
        fmt::format("an L2 of {} bytes has no room for a buffer that L1s of {} bytes cannot keep", l2, l1));
  kernel.before = kThread + "mul.wide.u32 %rd2,%r1,16;\n";
  const auto lap = uint32_t(kernel.bytes / (share * kernel.blocks * kLoads)) + 1;
  return read_stream(kernel, step * share, 2 * lap, 4 * lap, gpu);
}

// Returns the GB/s of writes back to DRAM. What the L2 holds when the launch ends stays there, so both
// lengths are larger than the L2. The launch ends when its writes are in the L2, whatever the configuration
// says, because writes that wait in the network are not done yet.
double write_stream(pipeline::GpuParams gpu) {
  gpu.core.ends_when_written = true;
  constexpr uint32_t kFew = 96, kMany = 160;  // MB
  MicroKernel kernel;
  kernel.bytes = uint64_t{kMany} << 20;
  kernel.threads = full_block(gpu);
  kernel.blocks = gpu.cores * 2;
  const uint64_t threads = uint64_t{kernel.blocks} * kernel.threads;
  kernel.before = kThread + "mad.wide.u32 %rd2,%r1,16,%rd0;\n";
  kernel.body =
      fmt::format("st.global.v4.u32 [%rd2],{{%r1,%r1,%r1,%r1}};add.s64 %rd2,%rd2,{};\n", threads * 16);
  const auto turns = [&](uint32_t megabytes) {
    return uint32_t((uint64_t{megabytes} << 20) / (threads * 16));
  };
  return double(threads * 16) / cycles_per_turn(kernel, turns(kFew), turns(kMany), gpu) * gpu.clock_mhz *
         1e-3;
}

// Returns how many G lane operations of red.global.add.u32 all cores do per second. `place` computes from
// %r1, the thread's number, the offset of its word.
double red_throughput(const std::string& place, const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.threads = full_block(gpu);
  kernel.blocks = gpu.cores * 2;
  const uint64_t threads = uint64_t{kernel.blocks} * kernel.threads;
  kernel.bytes = threads * 4;
  kernel.before = kThread + place + "mad.wide.u32 %rd1,%r1,4,%rd0;\n";
  kernel.body = "red.global.add.u32 [%rd1],%r2;\n";
  return double(threads) / cycles_per_body(kernel, 8, 24, gpu) * gpu.clock_mhz * 1e-3;
}

double atomic(const std::string& op, uint32_t lanes, uint32_t stride, const pipeline::GpuParams& gpu) {
  const bool shared = op.starts_with("atom.shared");
  std::string before = fmt::format("setp.lt.u32 %p1,%r1,{};mul.lo.u32 %r1,%r1,{};\n", lanes, stride);
  before += shared ? "mov.u32 %r2,room;add.u32 %r1,%r1,%r2;cvt.u64.u32 %rd1,%r1;\n"
                   : "cvt.u64.u32 %rd1,%r1;add.s64 %rd1,%rd1,%rd0;\n";
  before += "mov.u32 %r3,0;\n@!%p1 bra SKIP;\n";
  const char* operands = op.find("cas") != std::string::npos   ? "%r4,[%rd1],%r3,%r3;\n"
                         : op.find("f32") != std::string::npos ? "%f4,[%rd1],%f3;mov.b32 %r4,%f4;\n"
                                                               : "%r4,[%rd1],%r3;\n";
  // The result is 0. It is the next operation's operand and a part of its address.
  MicroKernel kernel;
  kernel.before = "mov.u32 %r1,%laneid;mov.f32 %f3,0f00000000;\n" + before;
  kernel.body = op + " " + operands + "mad.wide.u32 %rd1,%r4,4,%rd1;\n";
  kernel.after = "st.global.u64 [%rd0],%rd1;\nSKIP:\n";
  kernel.variables = shared ? kShared : "";
  kernel.turns = 4;
  kernel.bytes = 1 << 16;
  return cycles_per_body(kernel, 8, 24, with_one_core(gpu));
}

void add_chases(std::vector<MicroBench>& out) {
  for (uint64_t bytes : {2048u, 32768u, 131072u, 524288u, 1048576u, 4194304u})
    out.push_back({"chase", "ld.global.ca", fmt::format("bytes={};stride=128", bytes), "cycle",
                   [bytes](const auto& gpu) { return chase(bytes, 128, true, gpu); }});
  for (uint64_t bytes : {67108864u, 268435456u})
    out.push_back({"chase", "ld.global.cg (cold,DRAM)", fmt::format("bytes={};stride=1024", bytes), "cycle",
                   [bytes](const auto& gpu) { return chase(bytes, 1024, false, gpu); }});
  for (uint32_t bytes : {1024u})
    out.push_back({"shared", "ld.shared chase", fmt::format("bytes={}", bytes), "cycle",
                   [](const auto& gpu) { return shared_chase(8, gpu); }});
  out.push_back({"const", "ld.const chase", "bytes=1024;stride=4", "cycle", [](const auto& gpu) {
                   return chain("mov.u32 %r2,table;mov.u32 %r1,%r2;\n",
                                "ld.const.u32 %r4,[%r1];mad.lo.u32 %r1,%r4,4,%r2;\n",
                                "st.global.u32 [%rd0],%r1;\n", gpu, ".const .align 8 .b8 table[256];\n");
                 }});
}

void add_conflicts(std::vector<MicroBench>& out) {
  for (uint32_t stride : {4u, 8u, 16u, 32u, 64u, 128u, 132u})
    out.push_back({"smem_bank", "throughput 32 warps", fmt::format("stride={}", stride), "cycle/load",
                   [stride](const auto& gpu) { return shared_throughput(stride, "v1", gpu); }});
  for (uint32_t stride : {4u, 8u, 12u, 16u, 20u, 24u, 32u, 40u, 48u, 64u, 96u, 128u, 132u, 256u})
    out.push_back({"coalesce", "L1(.ca) thr 32 warps", fmt::format("stride={}", stride), "cycle/load",
                   [stride](const auto& gpu) { return l1_throughput(stride, "v1", 32, gpu); }});
  for (uint32_t stride : {4u, 8u, 16u, 32u, 64u, 128u, 132u})
    out.push_back({"coalesce", "L1(.ca) latency", fmt::format("stride={}", stride), "cycle",
                   [stride](const auto& gpu) { return l1_latency(stride, gpu); }});
}

void add_bandwidths(std::vector<MicroBench>& out) {
  const std::pair<const char*, uint32_t> widths[] = {{"v1", 4}, {"v2", 8}, {"v4", 16}};
  for (const auto& [width, bytes] : widths) {
    const std::string w = width;
    const uint32_t b = bytes;
    out.push_back({"smbw", "L1 .ca " + w, "threads=1024", "B/cycle",
                   [w, b](const auto& gpu) { return 32 * b / l1_throughput(b, w, 32, gpu); }});
    out.push_back({"smbw", "shared " + w, "threads=1024", "B/cycle",
                   [w, b](const auto& gpu) { return 32 * b / shared_throughput(b, w, gpu); }});
  }
  out.push_back({"bw", "L2 read 8MiB x128", "", "GB/s", [](const auto& gpu) { return l2_stream(gpu); }});
  out.push_back(
      {"bw", "DRAM read 8GiB", "", "GB/s", [](const auto& gpu) { return dram_stream(64 << 20, gpu); }});
  out.push_back({"bw", "DRAM write 8GiB", "", "GB/s", write_stream});
}

void add_atomics(std::vector<MicroBench>& out) {
  for (const char* op : {"atom.global.add.u32", "atom.global.cas.b32", "atom.global.add.f32",
                         "atom.shared.add.u32", "atom.shared.cas.b32"})
    for (const auto& [lanes, stride] : {std::pair{1u, 0u}, {32u, 0u}, {32u, 4u}})
      out.push_back({"atomic", op, fmt::format("lanes={};lanestride={}", lanes, stride), "cycle",
                     [op, l = lanes, s = stride](const auto& gpu) { return atomic(op, l, s, gpu); }});
  const std::pair<const char*, const char*> places[] = {
      {"every thread own word", ""},
      {"lanes contiguous, all warps same line", "and.b32 %r1,%r1,31;\n"},
      {"one address per block", "mov.u32 %r1,%ctaid.x;\n"}};
  for (const auto& [name, place] : places)
    out.push_back({"atomic_thr", name + std::string(",red.global.add.u32"), " 2x1024 thr/SM", "Gop/s",
                   [p = std::string(place)](const auto& gpu) { return red_throughput(p, gpu); }});
}

}  // namespace

std::vector<MicroBench> memory_benchmarks() {
  std::vector<MicroBench> out;
  add_chases(out);
  add_conflicts(out);
  add_bandwidths(out);
  add_atomics(out);
  return out;
}

}  // namespace glint::app
