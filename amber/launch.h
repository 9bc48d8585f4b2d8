// One RUN: the script's resources in simulated memory, the machine, and the resources back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "amber/compile.h"

namespace glint::amber {

struct LaunchOptions {
  pipeline::GpuParams gpu;
  bool timing = false;   // cycle by cycle; else every effect at once
  bool no_skip = false;  // of the timing machine
};

// Runs `command` with shaders of its pipeline and leaves the buffers of `script` as they are afterwards. Returns the
// cycles, 0 without timing. Errors as pipeline::render().
uint64_t launch(Script& script, const Command& command, const std::vector<CompiledShader>& shaders, const LaunchOptions& options);

}  // namespace glint::amber
