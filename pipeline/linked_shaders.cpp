// Compiles stages and links them.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/linked_shaders.h"

#include <algorithm>
#include <utility>

#include "frontend/spirv/specialize.h"
#include "pipeline/software_traversal.h"

namespace glint::pipeline {

frontend::BackendOptions backend_options(const CompilerParams& compiler) {
  return {compiler.max_registers, compiler.schedule,      compiler.contract,      compiler.queries_call,
          compiler.guard_latency, compiler.reorder_calls, compiler.reorder_traces};
}

CompiledStage compile_stage(std::vector<uint32_t> words, const StageSource& source,
                            const CompilerParams& compiler, Diagnostics& notes,
                            frontend::ShaderCache* cache) {
  words = frontend::specialize(std::move(words), source.specialization);
  const auto validity = source.specialization.empty() ? source.validity : frontend::Validity::Unknown;
  frontend::CompiledModule module = frontend::compile_module(
      words, source.name, source.entry, backend_options(compiler), notes, cache, validity);
  // The module is valid now, because it compiled.
  return {frontend::reflect(words, source.name, source.entry), std::move(module.simplified),
          std::move(module.program)};
}

LinkedShaders::LinkedShaders(std::vector<isa::Program> programs,
                             const std::vector<frontend::Binding>& declared, const GpuParams& gpu,
                             frontend::ShaderCache* cache)
    : any_hit_(gpu.rt.any_hit.make({})),
      layout_(gpu.core.layout.make({})),
      nearest_first_hit_(gpu.rt.nearest_first_hit) {
  add_traversal(programs, gpu, cache);
  image_ = exec::link(programs);
  for (const frontend::Binding& binding : declared) {
    frontend::Binding& kept = declared_.try_emplace({binding.set, binding.binding}, binding).first->second;
    kept.count = std::max(kept.count, binding.count), kept.is_array |= binding.is_array;
  }
}

const frontend::Binding* LinkedShaders::declared_at(BindingPlace place) const {
  const auto found = declared_.find(place);
  return found == declared_.end() ? nullptr : &found->second;
}

void LinkedShaders::give_to(exec::World& world) const {
  world.image = &image_;
  world.any_hit = any_hit_;
  world.layout = layout_;
  world.nearest_first_hit = nearest_first_hit_;
}

}  // namespace glint::pipeline
