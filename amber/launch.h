// One RUN: the script's resources in simulated memory, the machine, and the resources back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "amber/compile.h"
#include "exec/fault.h"
#include "exec/print_log.h"

namespace glint::amber {

struct LaunchOptions {
  pipeline::GpuParams gpu;
  bool timing = false;   // cycle by cycle; else every effect at once
  bool no_skip = false;  // of the timing machine
  uint32_t threads = 1;  // of the host, for it
  exec::OnFault on_fault = exec::OnFault::Stop;
  exec::PrintLog* prints = nullptr;        // null: what shaders print is left out
  frontend::ShaderCache* cache = nullptr;  // null: shaders are compiled anew
};

// Runs `command` with shaders of its pipeline and leaves the buffers of `script` as they are afterwards.
// Errors as pipeline::render().
struct Launched {
  uint64_t cycles = 0;    // 0 without timing
  exec::FaultLog faults;  // that were let pass
};
Launched launch(Script& script, const Command& command, const std::vector<CompiledShader>& shaders,
                const LaunchOptions& options);

}  // namespace glint::amber
