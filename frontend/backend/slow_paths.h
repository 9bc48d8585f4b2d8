// Names the ops that hardware computes by a short sequence for most operands and by a call for the others.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::frontend {

// Returns true for divisions, reciprocals and square roots that round correctly, and for divisions of 64-bit
// integers. Source: machine code of kernels for sm_90 (bench/probes): each of these ops has a branch to a
// call behind the common sequence, and no load moves across that branch.
bool has_slow_path(uint16_t op);

}  // namespace glint::frontend
