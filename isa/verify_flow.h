// The paths of a program: what its lanes can reach, in which regions they are then, and what they have
// written.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "isa/program.h"

namespace glint::isa {

// Hears of a mistake at the instruction of that index.
using Complaint = std::function<void(size_t at, const std::string& what)>;

// Where a lane can go from the instruction at `at`: its target or targets, and the next instruction. A call
// goes to its function and, back from it, on.
std::vector<uint32_t> successors(const Program& program, size_t at);

// Reachability, and the regions and traces that are open on each path (isa/verify_regions.cpp). Expects
// operands and targets in range. False after a complaint.
bool verify_regions(const Program& program, const Complaint& complain);

// Registers and predicates that no instruction has written on some path to a reader, and frames:
// displacements from the stack pointer, the pointer at calls and returns. Expects a program that
// verify_regions accepts.
void verify_values(const Program& program, const Complaint& complain);

}  // namespace glint::isa
