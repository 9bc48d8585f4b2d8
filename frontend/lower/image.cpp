// Lowers images by texels: reads and writes of storage images, fetches, queries, handles.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/image.h"

#include <cstdint>
#include <fmt/format.h>
#include <span>
#include <utility>

namespace glint::frontend {

const Type& image_type(ModuleLowering& l, Id id) {
  const Type& type = l.module().type(id);
  return type.kind == Type::Kind::SampledImage ? l.module().type(type.element) : type;
}

std::optional<Geometry> geometry_of(ModuleLowering& l, Id id, bool single_texels) {
  const Type& type = image_type(l, id);
  // Samples are addressed as layers: with_sample().
  const bool layers = type.is_arrayed || type.is_multisampled;
  switch (type.dim) {
    case spv::Dim::Dim1D:
      return Geometry{layers ? "a1d" : "1d", 1, layers};
    case spv::Dim::Dim2D:
      return Geometry{layers ? "a2d" : "2d", 2, layers};
    case spv::Dim::Dim3D:
      return Geometry{"3d", 3, false};
    case spv::Dim::Buffer:
      return Geometry{"buffer", 1, false};
    case spv::Dim::Cube:
      if (single_texels) return Geometry{"a2d", 2, true};
      return Geometry{layers ? "acube" : "cube", 3, layers};
    default:
      break;
  }
  l.unsupported(
      fmt::format("images of dimension {}", type.dim == spv::Dim::SubpassData ? "SubpassData" : "Rect"));
  return std::nullopt;
}

std::string_view texel_suffix(ModuleLowering& l, Id id) {
  switch (l.part_of(image_type(l, id).element)) {
    case Part::Float32:
      return "f32";
    case Part::Int32:
      return "s32";
    case Part::Uint32:
      return "u32";
    case Part::Int64:
    case Part::Uint64:
      return "u32";  // in halves: from_halves()
    default:
      break;
  }
  l.unsupported("images of other than 32-bit and 64-bit texel types");
  return {};
}

// Adds the sample to the layer of a texel's place. Model: the samples of a texel are consecutive layers;
// hardware keeps them together.
Operands with_sample(ModuleLowering& l, Id id, const Operand& handle, Operands at,
                     const std::optional<Id>& sample) {
  const Type& type = image_type(l, id);
  if (!type.is_multisampled) return at;
  Operand layer = sample ? l.scalar(*sample) : Operand::value(0);
  if (type.is_arrayed) {
    const Operand samples = l.emit().fresh("txq.num_samples.b32", {handle});
    // A sample that the image lacks must not meet the next layer.
    const Operand is_there = l.emit().fresh("setp.lt.u32", {layer, samples});
    layer = l.emit().value("mad.lo.u32", {at.at(2), samples, layer});
    layer = l.emit().value("selp.b32", {layer, Operand::value(~uint32_t{0}), is_there});
  }
  at.resize(2);
  at.push_back(layer);
  return at;
}

Operands integer_place(Emitter&, const Geometry& geometry, const Operand& handle, const Operands& at) {
  Operands place{handle};
  if (geometry.has_layers) place.push_back(at.at(geometry.coordinates));
  place.insert(place.end(), at.begin(), at.begin() + geometry.coordinates);
  return place;
}

ImageOperands image_operands(const Instruction& inst, size_t at) {
  using Mask = spv::ImageOperandsMask;
  ImageOperands result;
  if (inst.operands.size() <= at) return result;
  const uint32_t mask = inst.operands[at++];
  const auto has = [&](Mask bit) { return (mask & uint32_t(bit)) != 0; };
  if (has(Mask::Bias)) result.bias = inst.operands.at(at++);
  if (has(Mask::Lod)) result.lod = inst.operands.at(at++);
  if (has(Mask::Grad)) {
    result.gradients = {inst.operands.at(at), inst.operands.at(at + 1)};
    at += 2;
  }
  if (has(Mask::ConstOffset)) result.offset = inst.operands.at(at++);
  if (has(Mask::Offset)) result.offset = inst.operands.at(at++);
  if (has(Mask::ConstOffsets)) result.offsets = inst.operands.at(at++);
  if (has(Mask::Sample)) result.sample = inst.operands.at(at++);
  return result;  // The other operands belong to the memory model.
}

bool has_halves(ModuleLowering& l, Id id) {
  return bytes_of(l.part_of(image_type(l, id).element)) == 8;
}

// Returns a texel of 64 bits, which images store as two channels of 32 bits. Red is this pair, green and blue
// are 0, and alpha is 1.
Operands from_halves(ModuleLowering& l, const Operands& words) {
  return {l.emit().value("pack.b64", {words[0], words[1]}), Operand::value(0), Operand::value(0),
          Operand::value(1)};
}
Operands to_halves(ModuleLowering& l, const Operand& red) {
  Emitter& e = l.emit();
  return {e.value("cvt.u32.u64", {red}),
          e.value("cvt.u32.u64", {e.value("shr.u64", {red, Operand::value(32)})})};
}

Operands four_words(ModuleLowering& l, const std::string& name, const Operands& sources) {
  if (isa::find_op(name) < 0) {
    l.unsupported("no op " + name);
    return Operands(4, Operand::value(0));
  }
  Operands texel;
  for (int i = 0; i < 4; ++i) texel.push_back(Operand::of(l.program().new_register(RegisterClass::B32)));
  Operands operands = texel;
  operands.insert(operands.end(), sources.begin(), sources.end());
  l.emit().effect(name, std::move(operands));
  return texel;
}

namespace {

// Returns how the op handles a place outside of the image. Vulkan drops stores to samples that an image
// lacks, whatever features are enabled, so stores to multisampled images drop all places outside.
std::string_view outside(ModuleLowering& l, Id type) {
  return image_type(l, type).is_multisampled ? "zero" : "trap";
}

void read(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Id type = l.type_of(inst.operands[0]);
  const auto geometry = geometry_of(l, type, true);
  if (!geometry || texel_suffix(l, type).empty()) return;
  const Operand image = l.scalar(inst.operands[0]);
  const Operands at = with_sample(l, type, image, l.value(inst.operands[1]), image_operands(inst, 2).sample);
  Operands texel = four_words(l, fmt::format("suld.p.{}.v4.b32.{}", geometry->name, outside(l, type)),
                              integer_place(l.emit(), *geometry, image, at));
  if (has_halves(l, type)) texel = from_halves(l, texel);
  texel.resize(l.layout().num_parts(inst.type));
  l.set(inst.result, std::move(texel));
}

void write(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Id type = l.type_of(inst.operands[0]);
  const auto geometry = geometry_of(l, type, true);
  if (!geometry || texel_suffix(l, type).empty()) return;
  const Operand image = l.scalar(inst.operands[0]);
  const Operands at = with_sample(l, type, image, l.value(inst.operands[1]), image_operands(inst, 3).sample);
  Operands operands = integer_place(l.emit(), *geometry, image, at);
  Operands texel = l.value(inst.operands[2]);
  if (has_halves(l, type)) texel = to_halves(l, texel[0]);
  for (size_t i = 0; i < 4; ++i) operands.push_back(i < texel.size() ? texel[i] : Operand::value(0));
  l.emit().effect(fmt::format("sust.p.{}.v4.b32.{}", geometry->name, outside(l, type)), std::move(operands));
  l.note_store(PointerSpace::Global);  // Choice: images and buffers may share memory.
}

void fetch(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Id type = l.type_of(inst.operands[0]);
  const auto geometry = geometry_of(l, type, true);
  const std::string_view suffix = texel_suffix(l, type);
  if (!geometry || suffix.empty()) return;
  const ImageOperands extra = image_operands(inst, 2);
  Operands at = l.value(inst.operands[1]);
  if (extra.offset) {
    const Operands offset = l.value(*extra.offset);
    for (size_t i = 0; i < offset.size(); ++i) at[i] = l.emit().value("add.s32", {at[i], offset[i]});
  }
  const Operand image = l.scalar(inst.operands[0]);
  Operands sources =
      integer_place(l.emit(), *geometry, image, with_sample(l, type, image, std::move(at), extra.sample));
  const bool has_level = extra.lod && !is_constant(l.scalar(*extra.lod), 0);
  if (has_level) sources.push_back(l.scalar(*extra.lod));
  const Operands texel = four_words(
      l, fmt::format("tex{}.{}.v4.{}.s32", has_level ? ".level" : "", geometry->name, suffix), sources);
  l.set(inst.result, has_halves(l, type) ? from_halves(l, texel) : texel);
}

// Lowers a query of the extents of a level or of the image, followed by the number of layers.
void query_size(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Type& type = image_type(l, l.type_of(inst.operands[0]));
  const auto geometry = geometry_of(l, l.type_of(inst.operands[0]), false);
  if (!geometry) return;
  const std::string_view family = type.is_storage_image ? "suq" : "txq";
  const bool has_level = inst.op == spv::Op::OpImageQuerySizeLod;
  Operands sources{l.scalar(inst.operands[0])};
  if (has_level) sources.push_back(l.scalar(inst.operands[1]));
  const uint32_t axes = type.dim == spv::Dim::Cube ? 2 : geometry->coordinates;
  constexpr std::string_view kAxes[] = {"width", "height", "depth"};
  Operands result;
  for (uint32_t axis = 0; axis < axes; ++axis)
    result.push_back(
        l.emit().fresh(fmt::format("{}.{}{}.b32", family, has_level ? "level." : "", kAxes[axis]), sources));
  if (type.is_arrayed)
    result.push_back(l.emit().fresh(fmt::format("{}.array_size.b32", family), {sources[0]}));
  l.set(inst.result, std::move(result));
}

void query(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, {l.emit().fresh(row.name32, {l.scalar(inst.operands[0])})});
}

// Lowers the ops that take the image's part of a handle, and that join both parts (isa/image_access.h).
void image_of(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  constexpr uint32_t kImagePart = (1u << isa::kHandleSamplerShift) - 1;
  l.set(inst.result, {l.emit().value("and.b32", {l.scalar(inst.operands[0]), Operand::value(kImagePart)})});
}
void combine(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, {l.emit().value("or.b32", {l.scalar(inst.operands[0]), l.scalar(inst.operands[1])})});
}

void texel_pointer(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Pointer image = l.pointer(inst.operands[0]);
  Pointer p = nowhere(l.module().type(inst.type).element);
  const auto geometry = geometry_of(l, image.type, true);
  if (geometry && !texel_suffix(l, image.type).empty()) {
    p.space = PointerSpace::Texel;
    p.shape = geometry->name;
    const Operand handle = l.load(image)[0];
    p.texel = integer_place(l.emit(), *geometry, handle,
                            with_sample(l, image.type, handle, l.value(inst.operands[1]), inst.operands[2]));
  }
  l.set_pointer(inst.result, p);
}

using enum spv::Op;
constexpr LoweringRow kImageRows[] = {
    {OpImageRead, read, ""},
    {OpImageWrite, write, ""},
    {OpImageFetch, fetch, ""},
    {OpImageQuerySize, query_size, ""},
    {OpImageQuerySizeLod, query_size, ""},
    {OpImageQueryLevels, query, "txq.num_mipmap_levels.b32"},
    {OpImageQuerySamples, query, "txq.num_samples.b32"},
    {OpImage, image_of, ""},
    {OpSampledImage, combine, ""},
    {OpImageTexelPointer, texel_pointer, ""},
};

}  // namespace

std::span<const LoweringRow> image_rows() {
  return kImageRows;
}

}  // namespace glint::frontend
