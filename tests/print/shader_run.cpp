// Builds the smallest world that a shader runs in, and runs the shader.
// SPDX-License-Identifier: Apache-2.0
#include "tests/print/shader_run.h"

#include <cstring>

#include "base/diagnostics.h"
#include "isa/verify.h"
#include "pipeline/functional_machine.h"
#include "pipeline/timing_machine.h"

namespace glint::test {

isa::Program compile_text(const ShaderRun& run, const std::string& text) {
  const std::string name = run.stage == isa::Stage::Compute ? "text.comp" : "text.rgen";
  Diagnostics diagnostics;
  const std::vector<uint32_t> spirv =
      frontend::glsl_text_to_spirv("#version 460\n" + text, name, run.stage, run.glsl);
  isa::Program program =
      frontend::compile_module(spirv, name, "", run.backend, diagnostics, run.glsl.cache).program;
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  return program;
}

std::string run_program(ShaderRun& run, const isa::Program& program) {
  constexpr uint64_t kBudget = 1'000'000;
  const exec::Image image = exec::link({program});
  mem::AddressSpace memory;
  exec::PrintLog prints(run.print_limit);
  exec::World world;
  world.image = &image;
  world.memory = &memory;
  world.prints = &prints;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.raygen = 0;
  world.local_bytes = (program.local_bytes + 15) / 16 * 16;
  if (run.stage == isa::Stage::Compute)
    exec::set_blocks(world, run.size, program.local_size, program.shared_bytes);
  else
    world.launch_size = run.size;
  exec::place_plain_table(world, memory.allocate("binding table", exec::plain_table_bytes(world)));
  const uint64_t bytes = run.words.size() * 4;
  const Address at = memory.allocate("words", std::max<uint64_t>(bytes, 4));
  memory.write(at, run.words.data(), bytes);
  const uint64_t descriptor[2] = {at, bytes};
  std::memcpy(world.constant_bank.data(), descriptor, sizeof descriptor);
  if (run.timing) {
    pipeline::GpuParams gpu;
    gpu.cores = 3;
    gpu.core.instruction_budget = kBudget;
    pipeline::TimingMachine(gpu, world, false).run({});
  } else {
    pipeline::run_functional(world, kBudget, {});
  }
  const auto now = memory.view<uint32_t>(at, run.words.size());
  run.words.assign(now.begin(), now.end());
  return prints.take();
}

std::string run_text(ShaderRun& run, const std::string& text) {
  return run_program(run, compile_text(run, text));
}

}  // namespace glint::test
