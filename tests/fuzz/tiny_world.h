// A world just large enough that every kind of shader has something to do: two shapes, a few buffers, one
// warp.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "isa/program.h"

namespace glint::fuzz {

// Whether the machine has all that the program asks for: its shared memory and block fit.
bool can_run(const isa::Program& program);

// Runs a verified program of any stage: ray generation and compute shaders themselves, others below a driver
// that traces. Returns the fault that ended it, "" if it ended by itself. A program that runs on is stopped:
// a fault too.
std::string run(const isa::Program& program, uint64_t max_instructions);

}  // namespace glint::fuzz
