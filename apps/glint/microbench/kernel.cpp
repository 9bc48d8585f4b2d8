// Launches the kernels of the microbenchmarks.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/microbench/kernel.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "pipeline/timing_machine.h"

namespace glint::app {

std::string text_of(const MicroKernel& kernel) {
  std::string text = ".version 8.0\n.target sm_90\n.address_size 64\n" + kernel.variables +
                     ".visible .entry bench(.param .u64 data, .param .u32 n)\n{\n"
                     ".reg .f32 %f<64>; .reg .f64 %d<64>; .reg .b32 %r<64>; .reg .b64 %rd<64>; .reg .b16 "
                     "%h<64>; .reg .pred %p<64>;\n"
                     ".reg .u32 %turn;\n"
                     "ld.param.u64 %rd0, [data];\nld.param.u32 %r0, [n];\nmov.u32 %turn, %r0;\n";
  text += kernel.before;
  if (kernel.is_loop) text += "TURN:\n";
  for (uint32_t i = 0; i < kernel.unroll; ++i) {
    std::string body = kernel.body;
    for (size_t at; (at = body.find('#')) != std::string::npos;) body.replace(at, 1, std::to_string(i));
    text += body;
  }
  if (kernel.is_loop) text += "sub.u32 %turn, %turn, 1;\nsetp.ne.u32 %p63, %turn, 0;\n@%p63 bra TURN;\n";
  return text + kernel.after + "ret;\n}\n";
}

uint64_t cycles_of(const MicroKernel& kernel, const pipeline::GpuParams& gpu) {
  const frontend::PtxOptions options = pipeline::ptx_options(gpu.compiler);
  pipeline::KernelWorld world(frontend::compile_ptx(text_of(kernel), "microbench", "bench", options));
  const uint64_t bytes = std::max<uint64_t>(kernel.bytes, kernel.data.size() * 8);
  const Address data = world.memory().allocate("data", bytes);
  // Words of the buffer that begin with 1 are places in the buffer, for pointer chases.
  std::vector<uint64_t> words = kernel.data;
  for (uint64_t& word : words)
    if (word & 1) word = data + (word & ~uint64_t{1});
  world.memory().write(data, words.data(), words.size() * 8);
  world.set_grid({{kernel.blocks, 1, 1}, {kernel.threads, 1, 1}, 0});
  world.set_arguments({pipeline::KernelWorld::argument(data), pipeline::KernelWorld::argument(kernel.turns)});
  // Chains of dependent misses run for longer than warps may that seem to spin.
  pipeline::GpuParams patient = gpu;
  patient.core.livelock_budget = patient.core.turnover_budget = 0;
  return pipeline::TimingMachine(patient, world.world, false).run({});
}

double cycles_per_body(MicroKernel kernel, uint32_t few, uint32_t many, const pipeline::GpuParams& gpu) {
  kernel.unroll = few;
  const uint64_t less = cycles_of(kernel, gpu);
  kernel.unroll = many;
  return (double(cycles_of(kernel, gpu)) - double(less)) / double(uint64_t{many - few} * kernel.turns);
}

double cycles_per_turn(MicroKernel kernel, uint32_t few, uint32_t many, const pipeline::GpuParams& gpu) {
  kernel.turns = few;
  const uint64_t less = cycles_of(kernel, gpu);
  kernel.turns = many;
  return (double(cycles_of(kernel, gpu)) - double(less)) / double(many - few);
}

uint32_t full_block(const pipeline::GpuParams& gpu) {
  return 32 * std::min(32u, gpu.core.warps);
}

pipeline::GpuParams with_one_core(pipeline::GpuParams gpu) {
  gpu.cores = 1;
  return gpu;
}

}  // namespace glint::app
