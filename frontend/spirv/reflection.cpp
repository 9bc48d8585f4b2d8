// Reflects a parsed module: storage class and type give the kinds of descriptors.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/reflection.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "frontend/lower/layout.h"
#include "frontend/spirv/module.h"

namespace glint::frontend {
namespace {

using Storage = spv::StorageClass;

BindingKind kind_of(const Type& type, Storage storage) {
  switch (type.kind) {
    case Type::Kind::Struct:
      return storage == Storage::Uniform && !type.is_buffer_block ? BindingKind::UniformBuffer
                                                                  : BindingKind::StorageBuffer;
    case Type::Kind::SampledImage:
      return BindingKind::SampledImage;
    case Type::Kind::Sampler:
      return BindingKind::Sampler;
    case Type::Kind::AccelerationStructure:
      return BindingKind::AccelerationStructure;
    case Type::Kind::Image:
      return type.is_storage_image ? BindingKind::StorageImage : BindingKind::SampledImage;
    default:
      return BindingKind::Other;
  }
}

isa::ImageShape shape_of(const Type& image) {
  using isa::ImageShape;
  switch (image.dim) {
    case spv::Dim::Dim1D:
      return image.is_arrayed ? ImageShape::A1d : ImageShape::D1;
    case spv::Dim::Dim3D:
      return ImageShape::D3;
    case spv::Dim::Cube:
      return image.is_arrayed ? ImageShape::Acube : ImageShape::Cube;
    case spv::Dim::Buffer:
      return ImageShape::Buffer;
    default:
      return image.is_arrayed ? ImageShape::A2d : ImageShape::D2;
  }
}

struct FormatName {
  spv::ImageFormat format;
  std::string_view name;
};
using enum spv::ImageFormat;
constexpr FormatName kFormatNames[] = {
    {Rgba32f, "rgba32f"},
    {Rgba16f, "rgba16f"},
    {R32f, "r32f"},
    {Rgba8, "rgba8"},
    {Rgba8Snorm, "rgba8_snorm"},
    {Rg32f, "rg32f"},
    {Rg16f, "rg16f"},
    {R11fG11fB10f, "r11f_g11f_b10f"},
    {R16f, "r16f"},
    {Rgba16, "rgba16"},
    {Rgb10A2, "rgb10_a2"},
    {Rg16, "rg16"},
    {Rg8, "rg8"},
    {R16, "r16"},
    {R8, "r8"},
    {Rgba16Snorm, "rgba16_snorm"},
    {Rg16Snorm, "rg16_snorm"},
    {Rg8Snorm, "rg8_snorm"},
    {R16Snorm, "r16_snorm"},
    {R8Snorm, "r8_snorm"},
    {Rgba32i, "rgba32i"},
    {Rgba16i, "rgba16i"},
    {Rgba8i, "rgba8i"},
    {R32i, "r32i"},
    {Rg32i, "rg32i"},
    {Rg16i, "rg16i"},
    {Rg8i, "rg8i"},
    {R16i, "r16i"},
    {R8i, "r8i"},
    {Rgba32ui, "rgba32ui"},
    {Rgba16ui, "rgba16ui"},
    {Rgba8ui, "rgba8ui"},
    {R32ui, "r32ui"},
    {Rgb10a2ui, "rgb10_a2ui"},
    {Rg32ui, "rg32ui"},
    {Rg16ui, "rg16ui"},
    {Rg8ui, "rg8ui"},
    {R16ui, "r16ui"},
    {R8ui, "r8ui"},
    {R64ui, "rg32ui"},  // A 64-bit texel is stored as two halves.
    {R64i, "rg32ui"},
};

// Returns GLSL's name for the format of a storage image, or an empty text when the image has no format or
// SPIR-V has gained a new one.
std::string_view format_name(spv::ImageFormat format) {
  for (const FormatName& row : kFormatNames)
    if (row.format == format) return row.name;
  return {};
}

void reflect_image(const Module& module, Id type, Binding& binding) {
  const Type* image = &module.type(type);
  if (image->kind == Type::Kind::SampledImage) image = &module.type(image->element);
  if (image->kind != Type::Kind::Image) return;
  binding.shape = shape_of(*image);
  binding.multisampled = image->is_multisampled;
  const Type& texel = module.type(image->element);
  binding.format = format_name(image->format);
  binding.texel = texel.kind == Type::Kind::Float        ? "f32"
                  : texel.is_signed && texel.width == 32 ? "s32"
                                                         : "u32";
}

Binding binding_of(const Module& module, const Variable& variable, const Decorations& d) {
  Binding binding;
  binding.set = d.set.value_or(0), binding.binding = d.binding.value_or(0);
  Id type = module.type(variable.type).element;
  if (module.type(type).kind == Type::Kind::Array || module.type(type).kind == Type::Kind::RuntimeArray) {
    binding.is_array = true;
    binding.count = module.type(type).kind == Type::Kind::Array ? module.type(type).count : 0;
    type = module.type(type).element;
  }
  binding.kind = kind_of(module.type(type), variable.storage);
  if (module.type(type).kind == Type::Kind::Struct) binding.block = block_type(module, type);
  reflect_image(module, type, binding);
  const auto name = module.names.find(variable.id);
  binding.name = name != module.names.end() && !name->second.empty() ? name->second : module.type(type).name;
  return binding;
}

// Returns the scalars of a payload, or an empty text for a payload that is too large for such a list to help.
std::string scalars_of(Layout& layout, Id type) {
  constexpr uint32_t kMostBytes = 4096;
  std::string out;
  if (layout.size(type) > kMostBytes) return out;
  for (const Leaf& leaf : layout.leaves(type, {}, 0)) {
    out += is_float(leaf.part) ? 'f' : leaf.part == Part::Bool ? 'b' : 'i';
    out += char('0' + bytes_of(leaf.part));
  }
  return out;
}

// Returns the variables that an entry point's function and the functions that it calls name.
std::set<Id> variables_used_by(const Module& module, const EntryPoint& entry) {
  // Since SPIR-V 1.4 the entry point lists them.
  if (module.version >= 0x10400) return entry.interface;
  std::set<Id> used, known{entry.function};
  std::vector<Id> open{entry.function};
  while (!open.empty()) {
    const Function* const function = module.function(open.back());
    open.pop_back();
    if (!function) continue;
    for (const Block& block : function->blocks)
      for (const Instruction& inst : block.code) {
        if (inst.op == spv::Op::OpFunctionCall && known.insert(inst.operands[0]).second)
          open.push_back(inst.operands[0]);
        // A literal may equal the number of a variable, which then counts as used.
        for (const uint32_t operand : inst.operands)
          if (module.variables.contains(operand)) used.insert(operand);
      }
  }
  return used;
}

// Returns the variables that belong to an entry point. Unused ones belong to it if it is alone.
std::set<Id> variables_of(const Module& module, const EntryPoint& entry) {
  if (module.entry_points.size() > 1) return variables_used_by(module, entry);
  std::set<Id> all;
  for (const auto& [id, variable] : module.variables) all.insert(id);
  return all;
}

}  // namespace

Reflection reflect(const std::vector<uint32_t>& spirv, const std::string& name,
                   const std::string& entry_point) {
  const Module module = Module::parse(spirv, name);
  Layout layout(module);
  Reflection result;
  const EntryPoint& entry = module.entry_point(entry_point, name);
  result.stage = stage_of(entry.model).value_or(isa::Stage::Compute);
  result.entry_point = entry.name;
  result.local_size = entry.local_size;
  for (const Id id : variables_of(module, entry)) {
    const Variable& variable = module.variables.at(id);
    const uint32_t bytes = layout.size(module.type(variable.type).element);
    switch (variable.storage) {
      case Storage::IncomingRayPayloadKHR:
        result.incoming_payload_bytes = std::max(result.incoming_payload_bytes, bytes);
        result.incoming_payload = scalars_of(layout, module.type(variable.type).element);
        break;
      case Storage::RayPayloadKHR:
        result.largest_payload_bytes = std::max(result.largest_payload_bytes, bytes);
        result.handed_payloads.push_back(scalars_of(layout, module.type(variable.type).element));
        break;
      case Storage::HitAttributeKHR:
        result.attribute_bytes = std::max(result.attribute_bytes, bytes);
        break;
      case Storage::PushConstant:
        result.push_constant_bytes = bytes;
        result.push_constants = block_type(module, module.type(variable.type).element);
        break;
      case Storage::ShaderRecordBufferKHR:
        result.shader_record = block_type(module, module.type(variable.type).element);
        break;
      default: {
        const auto d = module.decorations.find(id);
        if (d != module.decorations.end() && d->second.binding)
          result.bindings.push_back(binding_of(module, variable, d->second));
        break;
      }
    }
  }
  std::sort(result.bindings.begin(), result.bindings.end(), [](const Binding& a, const Binding& b) {
    return std::pair(a.set, a.binding) < std::pair(b.set, b.binding);
  });
  return result;
}

}  // namespace glint::frontend
