// Compares a script's bindings with the declarations of its shaders.
// SPDX-License-Identifier: Apache-2.0
#include "amber/declared_binding.h"

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "pipeline/description/modules.h"

namespace glint::amber {

const frontend::Binding* reflected(const Binding& binding, const std::vector<CompiledShader>& shaders) {
  const frontend::Binding* out = nullptr;
  for (const CompiledShader& shader : shaders)
    for (const frontend::Binding& each : shader.reflection.bindings)
      if (each.set == binding.set && each.binding == binding.binding && (!out || each.count > out->count))
        out = &each;
  return out;
}

void check_kind(const Binding& binding, const std::vector<CompiledShader>& shaders) {
  using frontend::BindingKind;
  const auto takes = [&](BindingKind kind) {
    switch (binding.kind) {
      case BindKind::Uniform:
      case BindKind::Storage:
        return kind == BindingKind::UniformBuffer || kind == BindingKind::StorageBuffer;
      case BindKind::Sampler:
        return kind == BindingKind::Sampler;
      case BindKind::Structure:
        return kind == BindingKind::AccelerationStructure;
      case BindKind::PushConstants:
        return true;
      default:
        return kind == BindingKind::SampledImage || kind == BindingKind::StorageImage;
    }
  };
  const frontend::Binding* other = nullptr;
  for (const CompiledShader& shader : shaders)
    for (const frontend::Binding& each : shader.reflection.bindings) {
      if (each.set != binding.set || each.binding != binding.binding) continue;
      if (takes(each.kind)) return;
      other = &each;
    }
  if (other && !binding.names.empty())
    throw UserError(
        binding.where,
        fmt::format("set {} binding {}: the shader declares the {} '{}', but '{}' is not one", binding.set,
                    binding.binding, pipeline::name_of(other->kind), other->name, binding.names[0]));
}

}  // namespace glint::amber
