// Performs one RUN: puts the script's resources into simulated memory, runs the machine and reads the
// resources back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "amber/compile.h"
#include "exec/fault.h"
#include "exec/print_log.h"

namespace glint::amber {

struct LaunchOptions {
  pipeline::GpuParams gpu;
  // True stands for the timing machine, and false for the functional machine, where every effect is
  // immediate.
  bool timing = false;
  bool no_skip = false;  // for the timing machine
  uint32_t threads = 1;  // threads of the host, for the timing machine
  exec::OnFault on_fault = exec::OnFault::Stop;
  // With true, an access outside of a buffer or an image is a fault unless the script declares a feature for
  // robust access.
  bool strict = false;
  exec::PrintLog* prints = nullptr;        // null: the output of shaders is left out
  frontend::ShaderCache* cache = nullptr;  // null: every shader is compiled anew
};

// Runs `command` with the shaders of its pipeline and leaves the buffers of `script` as they are afterwards.
// Throws the same errors as pipeline::render().
struct Launched {
  uint64_t cycles = 0;    // 0 without timing
  exec::FaultLog faults;  // faults that were reported as warnings
};
Launched launch(Script& script, const Command& command, const std::vector<CompiledShader>& shaders,
                const LaunchOptions& options);

}  // namespace glint::amber
