// Runs the passes of the backend.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/calls.h"
#include "frontend/backend/emit.h"
#include "frontend/backend/guarded_results.h"
#include "frontend/backend/if_convert.h"
#include "frontend/backend/live_words.h"
#include "frontend/backend/peephole.h"
#include "frontend/backend/schedule.h"
#include "frontend/backend/word_halves.h"
#include "frontend/compile.h"
#include "frontend/pass_times.h"

namespace glint::frontend {

isa::Program assemble(VirtualProgram program, const BackendOptions& options, PassTimes* times) {
  const Ops ops;
  const auto pass = [&](const char* name, const auto& work) {
    const PassTimer timer(times, "backend", name);
    return work();
  };
  pass("simplify-code", [&] { simplify_code(program, ops); });
  pass("convert-selections", [&] { convert_selections(program, ops, options.like_an_assembler); });
  if (options.like_an_assembler) {
    pass("guard-results", [&] { guard_selected_results(program, ops); });
    pass("read-halves", [&] { read_halves(program, ops); });
  }
  pass("keep-predicates", [&] { keep_predicates_across_calls(program, ops); });
  if (options.schedule)
    pass("schedule",
         [&] { schedule(program, options.max_registers, options.guard_latency, options.like_an_assembler); });
  Allocation allocation = pass("allocate", [&] { return allocate(program, options.max_registers, ops); });
  if (options.reorder_calls) pass("count-live-words", [&] { count_live_words(program, allocation); });
  pass("expand-calls", [&] { expand_calls(program, allocation, ops); });
  return pass("emit", [&] { return emit(program, allocation, ops); });
}

isa::Program assemble(VirtualProgram program, const BackendOptions& options) {
  return assemble(std::move(program), options, nullptr);
}

}  // namespace glint::frontend
