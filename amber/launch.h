// Performs one RUN on the memory and the GPU of its script.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "amber/buffer_memory.h"
#include "amber/compile.h"
#include "amber/structure_memory.h"
#include "exec/fault.h"
#include "exec/print_log.h"
#include "pipeline/device.h"
#include "pipeline/linked_shaders.h"

namespace glint::amber {

// Tells who watches a script what a launch is.
struct ScriptLaunch {
  uint32_t number = 0;   // counted from 0 over the whole script
  std::string pipeline;  // its name
  std::string shaders;   // their names, with spaces between them
  const exec::World& world;
};

// Is called for each launch instead of the machine. It calls `run` once, which runs the launch, and may keep
// what it wants of the result.
using RecordLaunch =
    std::function<void(const ScriptLaunch& launch, const std::function<pipeline::RenderResult()>& run)>;

struct LaunchOptions {
  pipeline::GpuParams gpu;
  // Says which machine runs the launches, what they find in the caches, and what is noted of them.
  pipeline::LaunchMode mode{.timing = false, .observe = {}};
  pipeline::LaunchWatch watch;
  RecordLaunch record;  // nothing: nobody records
  exec::OnFault on_fault = exec::OnFault::Stop;
  // With true, an access outside of a buffer or an image is a fault unless the script declares a feature for
  // robust access.
  bool strict = false;
  exec::PrintLog* prints = nullptr;        // null: the output of shaders is left out
  frontend::ShaderCache* cache = nullptr;  // null: every shader is compiled anew
};

// Holds the memory of a script, in which buffers and structures live from launch to launch.
struct ScriptMemory {
  ScriptMemory(const Script& script, const rt::BuildOptions& options) : structures(script, space, options) {}

  mem::AddressSpace space;
  BufferMemory buffers{space};
  StructureMemory structures;
};

// Holds the code of a pipeline, which is compiled once.
struct CompiledPipeline {
  CompiledPipeline(std::vector<CompiledShader> compiled, const LaunchOptions& options);

  const std::vector<CompiledShader> shaders;
  const pipeline::LinkedShaders linked;
};

struct Launched {
  bool is_launch = false;  // false: it had no threads
  pipeline::LaunchEnd end = pipeline::LaunchEnd::Whole;
  uint64_t cycles = 0;      // 0 without timing
  exec::FaultLog faults{};  // faults that were reported as warnings
};

// Runs `command` with the code of its pipeline and leaves the buffers of `script` as they are afterwards.
// Throws the same errors as pipeline::render(). `number` is that of ScriptLaunch.
Launched launch(Script& script, const Command& command, const CompiledPipeline& code, ScriptMemory& memory,
                pipeline::Device& device, const LaunchOptions& options, uint32_t number);

}  // namespace glint::amber
