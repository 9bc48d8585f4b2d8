// Finds which instructions of a straight run have to wait for which others.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "frontend/virtual_program.h"

namespace glint::frontend {

// Says that instruction `to` of a run issues at least `delay` cycles after instruction `from`.
struct Dependence {
  size_t from, to;
  uint32_t delay;
};

// Returns the dependences of the run `code` through registers and through memory. `latency` gives the cycles
// from an instruction's issue to that of a dependent one. `guard_latency` is added before a predicate guards.
std::vector<Dependence> find_dependences(const std::vector<VirtualInst>& code,
                                         const std::function<uint32_t(const VirtualInst&)>& latency,
                                         uint32_t guard_latency);

}  // namespace glint::frontend
