// Declares a world that is just large enough for every kind of shader: two shapes, a few buffers and a launch
// of 40 lanes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "isa/program.h"

namespace glint::fuzz {

// Returns whether the machine has the shared memory and local memory that the program asks for.
bool can_run(const isa::Program& program);

// Runs a verified program of any stage. Ray generation and compute shaders run by themselves, and others
// below a driver that traces. Returns the fault that ended the run, or "" if the program ended by itself. A
// program that does not end is stopped, which counts as a fault.
std::string run(const isa::Program& program, uint64_t max_instructions);

}  // namespace glint::fuzz
