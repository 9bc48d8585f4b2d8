// Compiles the traversal program from the text that the build has put into `traversal_source`.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/software_traversal.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "exec/warp_context.h"
#include "isa/op_row.h"
#include "isa/ray_query.h"
#include "pipeline/traversal_source.h"

namespace glint::pipeline {
namespace {

constexpr std::string_view kName = "shaders/traversal/traversal.rcall";

bool program_traces_rays(const std::vector<isa::Program>& programs) {
  return std::any_of(programs.begin(), programs.end(), [](const isa::Program& program) {
    return std::any_of(program.code.begin(), program.code.end(), [](const isa::Inst& inst) {
      const isa::Effect effect = isa::op_table()[inst.op].effect;
      return effect == isa::Effect::Trace || effect == isa::Effect::QueryProceed;
    });
  });
}

void check(const GpuParams& gpu) {
  Diagnostics diagnostics;
  if (gpu.bvh.format.name != "bvh6")
    diagnostics.error({}, fmt::format("'rt.unit' is \"software\", whose program reads nodes of the format "
                                      "\"bvh6\", and 'bvh.format' is \"{}\"",
                                      gpu.bvh.format.name));
  if (gpu.rt.any_hit.name != "immediate")
    diagnostics.error({}, fmt::format("'rt.unit' is \"software\", whose program has no tables of candidates, "
                                      "and 'rt.any_hit' is \"{}\", not \"immediate\"",
                                      gpu.rt.any_hit.name));
  diagnostics.throw_if_errors();
}

// Returns the largest number of ray queries that the image's shaders number.
uint32_t num_queries(const exec::Image& image) {
  uint32_t count = 0;
  for (const exec::Step& step : image.code) {
    if (step.effect != isa::Effect::Query || step.row->detail != isa::detail_of(isa::Query::Initialize))
      continue;
    const isa::Slot number = step.inst.operand[0];
    const bool is_constant = number >> isa::kBankShift == isa::kConstantBank >> isa::kBankShift;
    const uint32_t last =
        is_constant ? image.constants[size_t(number & isa::kSlotIndexMask) * kLanes] : exec::kMaxNumbered - 1;
    count = std::max(count, std::min(last, exec::kMaxNumbered - 1) + 1);
  }
  return count;
}

}  // namespace

CompilerParams compiler_for(const GpuParams& gpu) {
  CompilerParams out = gpu.compiler;
  out.queries_call = gpu.rt.unit == rt::kSoftware;
  const core::Reorder::Where where = gpu.core.reorder.make({})->where();
  out.reorder_calls = where == core::Reorder::Where::Calls;
  out.reorder_traces = where == core::Reorder::Where::Traces;
  return out;
}

void add_traversal(std::vector<isa::Program>& programs, const GpuParams& gpu, frontend::ShaderCache* cache) {
  if (gpu.rt.unit != rt::kSoftware || !program_traces_rays(programs)) return;
  check(gpu);
  Diagnostics warnings;
  const std::string name(kName);
  frontend::GlslOptions glsl;
  glsl.cache = cache;
  const std::vector<uint32_t> spirv =
      frontend::glsl_text_to_spirv(traversal_source(), name, isa::Stage::Callable, glsl);
  // The program is never contracted, so every hit has the bits that the RT unit gives it.
  const frontend::BackendOptions backend{gpu.compiler.max_registers, gpu.compiler.schedule, false, false,
                                         gpu.compiler.guard_latency};
  programs.push_back(
      frontend::compile_module(spirv, name, {}, backend, warnings, cache, frontend::Validity::Known).program);
}

void place_records(exec::World& world, uint32_t stack_need) {
  const std::vector<exec::Shader>& shaders = world.image->shaders;
  if (shaders.empty() || shaders.back().name != kName) return;
  exec::TraversalCode& code = world.traversal;
  code.shader = uint32_t(shaders.size() - 1);
  code.stack_entries = std::max(stack_need, 1u);
  code.queries = num_queries(*world.image);
  const uint32_t records = world.max_trace_depth + (world.max_trace_depth + 1) * code.queries;
  code.first_record = (world.local_bytes + shaders.back().local_bytes + 15) / 16 * 16;
  world.local_bytes = code.first_record + records * code.record_bytes();
}

}  // namespace glint::pipeline
