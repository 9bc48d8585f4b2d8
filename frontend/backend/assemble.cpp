// Runs the passes of the backend.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/calls.h"
#include "frontend/backend/emit.h"
#include "frontend/backend/if_convert.h"
#include "frontend/backend/peephole.h"
#include "frontend/backend/schedule.h"
#include "frontend/compile.h"

namespace glint::frontend {

isa::Program assemble(VirtualProgram program, const BackendOptions& options) {
  const Ops ops;
  simplify_code(program, ops);
  convert_selections(program, ops);
  keep_predicates_across_calls(program, ops);
  if (options.schedule) schedule(program, options.max_registers, options.guard_latency);
  Allocation allocation = allocate(program, options.max_registers, ops);
  expand_calls(program, allocation, ops);
  return emit(program, allocation, ops);
}

}  // namespace glint::frontend
