// Rays without an RT unit (rt.unit = "software"): the traversal program beside a launch's shaders, and its
// records.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "exec/image.h"
#include "frontend/compile.h"
#include "pipeline/params.h"

namespace glint::pipeline {

// How shaders are compiled for the GPU.
CompilerParams compiler_for(const GpuParams& gpu);

// Compiles the program and puts it behind `programs` if they trace rays and the GPU has no RT unit. UserError
// where `gpu` asks for what only the RT unit can.
void add_traversal(std::vector<isa::Program>& programs, const GpuParams& gpu, frontend::ShaderCache* cache);

// After linking, with the depths and the stack of a lane known: where the records lie, if the program is
// there. `stack_need`: entries that the worst ray needs in any structure.
void place_records(exec::World& world, uint32_t stack_need);

}  // namespace glint::pipeline
