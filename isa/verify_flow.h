// Checks the paths of a program: what its lanes can reach, in which regions they are then, and what they have
// written.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "isa/program.h"

namespace glint::isa {

// Receives a mistake at the instruction with that index.
using Complaint = std::function<void(size_t at, const std::string& what)>;

// Returns where a lane can go from the instruction at `at`: its target or targets, and the next instruction.
// A call goes to its function and, after the return, to the next instruction.
std::vector<uint32_t> successors(const Program& program, size_t at);

// Checks reachability, and the regions and traces that are open on each path (isa/verify_regions.cpp). It
// expects operands and targets in range. Returns false after a complaint.
bool verify_regions(const Program& program, const Complaint& complain);

// Checks that instructions on every path to a reader have written its registers and predicates. It also
// checks frames: displacements from the stack pointer, and the stack pointer at calls and returns. It expects
// a program that verify_regions() accepts.
void verify_values(const Program& program, const Complaint& complain);

}  // namespace glint::isa
