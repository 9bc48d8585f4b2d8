// Measures the costs of control flow: loops, uniform and divergent branches, barriers, fences.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/glint/microbench/kernel.h"

namespace glint::app {
namespace {

double barrier(uint32_t warps, const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.threads = warps * 32;
  kernel.body = "bar.sync 0;\n";
  return cycles_per_body(kernel, 16, 48, with_one_core(gpu));
}

double fence(const std::string& op, bool store, const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.body = (store ? "st.global.u32 [%rd0],%r0;\n" : "") + op + ";\n";
  return cycles_per_body(kernel, 4, 12, with_one_core(gpu));
}

// Returns the cycles of a loop's back edge: the cycles of a turn with 64 multiply-adds, less those of another
// 64 multiply-adds. The counter is ready long before the branch.
double back_edge(const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  for (const char* f : {"%f10", "%f11", "%f12", "%f13"}) {
    kernel.body += fmt::format("fma.rn.f32 {0},{0},%f2,%f3;\n", f);
    kernel.after += fmt::format("st.global.f32 [%rd0],{};\n", f);
  }
  const auto turn_of = [&](uint32_t adds) {
    kernel.unroll = adds / 4;
    return cycles_per_turn(kernel, 16, 48, with_one_core(gpu));
  };
  return 2 * turn_of(64) - turn_of(128);
}

// Returns the cycles of an if that all lanes take, with its comparison: the cycles beyond those of its
// multiply-add.
double uniform_if(const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.before = "ld.global.u32 %r1,[%rd0];\n";
  kernel.body = "setp.ne.u32 %p1,%r1,%r0;\n@!%p1 bra SKIP#;\n" +
                std::string("fma.rn.f32 %f1,%f1,%f2,%f3;bar.warp.sync -1;\n") +
                "SKIP#:\nadd.u32 %r1,%r1,1;\n";
  kernel.after = "st.global.f32 [%rd0],%f1;\nst.global.u32 [%rd0],%r1;\n";
  kernel.is_loop = false;
  return cycles_per_body(kernel, 8, 24, with_one_core(gpu));
}

std::string adds(uint32_t n) {
  std::string out;
  for (uint32_t i = 0; i < n; ++i) out += "fma.rn.f32 %f1,%f1,%f2,%f3;\n";
  return out;
}

// Returns all cycles of `paths` groups of lanes, each with 64 dependent multiply-adds of its own.
double divergence(uint32_t paths, const pipeline::GpuParams& gpu) {
  MicroKernel kernel;
  kernel.is_loop = false;
  kernel.before = fmt::format("mov.u32 %r1,%laneid;and.b32 %r1,%r1,{};\n", paths - 1);
  for (uint32_t p = 0; p < paths; ++p) {
    const std::string n = std::to_string(p);
    kernel.body +=
        "setp.ne.u32 %p1,%r1," + n + ";\n@%p1 bra NEXT" + n + ";\n" + adds(64) + "NEXT" + n + ":\n";
  }
  kernel.after = "st.global.f32 [%rd0],%f1;\n";
  MicroKernel empty = kernel;
  empty.body.clear();
  const pipeline::GpuParams one = with_one_core(gpu);
  return double(cycles_of(kernel, one)) - double(cycles_of(empty, one));
}

}  // namespace

std::vector<MicroBench> flow_benchmarks() {
  std::vector<MicroBench> out;
  for (uint32_t warps : {1u, 2u, 4u, 8u, 16u, 32u})
    out.push_back({"bar", "bar.sync 0", fmt::format("warps={}", warps), "cycle",
                   [warps](const auto& gpu) { return barrier(warps, gpu); }});
  for (const char* op : {"membar.cta", "membar.gl", "membar.sys"})
    for (int store : {0, 1})
      out.push_back({"fence", op, fmt::format("store={}", store), "cycle",
                     [op, store](const auto& gpu) { return fence(op, store != 0, gpu); }});
  out.push_back({"branch", "back edge of a loop", "", "cycle", back_edge});
  out.push_back({"branch", "if that all lanes take", "", "cycle", uniform_if});
  for (uint32_t paths : {2u, 4u, 8u, 16u, 32u})
    out.push_back({"branch", "divergent paths of 64 fma", fmt::format("paths={}", paths), "cycle",
                   [paths](const auto& gpu) { return divergence(paths, gpu); }});
  return out;
}

}  // namespace glint::app
