// Reflects a parsed module: storage class and type give the kinds of descriptors.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/reflection.h"

#include <algorithm>
#include <string_view>

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

}  // namespace

Reflection reflect(const std::vector<uint32_t>& spirv, const std::string& name) {
  const Module module = Module::parse(spirv, name);
  Layout layout(module);
  Reflection result;
  if (module.entry_points.empty()) throw UserError({name, 0, 0}, "the module has no entry point");
  result.stage = stage_of(module.entry_points[0].model).value_or(isa::Stage::Compute);
  result.entry_point = module.entry_points[0].name;
  result.local_size = module.entry_points[0].local_size;
  for (const auto& [id, variable] : module.variables) {
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
