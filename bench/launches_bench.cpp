// Measures what a launch costs the host besides its simulation: small launches on one device, one after
// another.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "pipeline/device.h"
#include "pipeline/launch_builder.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

constexpr const char* kShader = R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Data { uint value[]; };
void main() { value[gl_GlobalInvocationID.x] += 1; }
)";

// Launches blocks of 64 threads. Each launch is built from host state, run and dropped, as a driver does.
void run_launches(benchmark::State& state, const char* preset, pipeline::Caches caches, uint32_t blocks) {
  const pipeline::GpuParams gpu = test::preset(preset);
  Diagnostics notes;
  const auto words = frontend::glsl_text_to_spirv(kShader, "count.comp", isa::Stage::Compute, {});
  const pipeline::CompiledStage stage =
      pipeline::compile_stage(words, {"count.comp", "", {}}, gpu.compiler, notes, nullptr);
  const pipeline::LinkedShaders shaders({stage.program}, stage.reflection.bindings, gpu, nullptr);
  mem::AddressSpace memory;
  const Address data = memory.allocate("data", uint64_t{blocks} * 256);
  pipeline::Device device(gpu);
  double cycles = 0;
  for (auto _ : state) {
    pipeline::LaunchBuilder builder(shaders, memory);
    builder.bind_buffers({0, 0}, {{data, uint64_t{blocks} * 256}});
    builder.set_blocks(0, {blocks, 1, 1});
    const pipeline::LaunchMode mode{true, false, 1, caches, {}};
    cycles += double(device.run(builder.finish(), mode, {}).cycles);
    for (const Address at : builder.allocations()) memory.free(at);
  }
  state.counters["cycles"] = cycles / double(state.iterations());
  state.counters["physical_bytes"] = double(memory.bytes_in_use());
}

#define GLINT_LAUNCHES(preset, name, blocks, caches)                                                   \
  BENCHMARK_CAPTURE(run_launches, name##_##blocks##_blocks_##caches, preset, pipeline::Caches::caches, \
                    blocks)                                                                            \
      ->Unit(benchmark::kMillisecond)
GLINT_LAUNCHES("mobile", mobile, 1, Cold);
GLINT_LAUNCHES("mobile", mobile, 256, Cold);
GLINT_LAUNCHES("mobile", mobile, 256, Warm);
GLINT_LAUNCHES("desktop", desktop, 256, Cold);
GLINT_LAUNCHES("h200", h200, 1, Cold);
GLINT_LAUNCHES("h200", h200, 256, Cold);
GLINT_LAUNCHES("h200", h200, 256, Warm);

}  // namespace

BENCHMARK_MAIN();
