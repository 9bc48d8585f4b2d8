// Traces rays without an RT unit (rt.unit = "software"), by a traversal program beside a launch's shaders.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "exec/image.h"
#include "frontend/compile.h"
#include "pipeline/params.h"

namespace glint::pipeline {

// Returns how shaders are compiled for the GPU.
CompilerParams compiler_for(const GpuParams& gpu);

// Compiles the program and appends it to `programs` when they trace rays and the GPU has no RT unit. Throws
// UserError when `gpu` asks for what only the RT unit can do.
void add_traversal(std::vector<isa::Program>& programs, const GpuParams& gpu, frontend::ShaderCache* cache);

// Sets where the records lie, when the program is there. It is called after linking, when the depths and the
// stack of a lane are known. `stack_need` is the number of entries that the worst ray needs in any structure.
void place_records(exec::World& world, uint32_t stack_need);

}  // namespace glint::pipeline
