// Lowers filtered reads of images: samples with levels, gradients, offsets and references, and gathers.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <span>

#include "frontend/lower/derivative.h"
#include "frontend/lower/image.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

bool has_reference(spv::Op op) {
  return op == OpImageSampleDrefExplicitLod || op == OpImageSampleDrefImplicitLod ||
         op == OpImageSampleProjDrefExplicitLod || op == OpImageSampleProjDrefImplicitLod ||
         op == OpImageDrefGather;
}
bool is_projective(spv::Op op) {
  return op == OpImageSampleProjExplicitLod || op == OpImageSampleProjImplicitLod ||
         op == OpImageSampleProjDrefExplicitLod || op == OpImageSampleProjDrefImplicitLod;
}

bool is_implicit(spv::Op op) {
  return op == OpImageSampleImplicitLod || op == OpImageSampleDrefImplicitLod ||
         op == OpImageSampleProjImplicitLod || op == OpImageSampleProjDrefImplicitLod;
}

// Returns the handle, the layer as an integer (in Vulkan, rounded to nearest even) and the coordinates.
Operands float_place(Emitter& e, const Geometry& geometry, const Operand& handle, const Operands& at) {
  Operands place{handle};
  if (geometry.has_layers) place.push_back(e.value("cvt.rni.s32.f32", {at.at(geometry.coordinates)}));
  place.insert(place.end(), at.begin(), at.begin() + geometry.coordinates);
  return place;
}

// Packs offsets in texels into one word, with a byte for each.
Operand packed_offset(Emitter& e, const Operands& offset) {
  Operand word = Operand::value(0);
  for (size_t i = 0; i < offset.size() && i < 3; ++i) {
    const Operand byte = e.value("and.b32", {offset[i], Operand::value(0xff)});
    word = e.value("or.b32", {word, e.value("shl.b32", {byte, Operand::value(8 * i)})});
  }
  return word;
}

struct Sample {
  Geometry geometry;
  std::string_view suffix;
  Operands place;
  std::optional<Operand> reference;
  ImageOperands extra;
};

// Reads what samples and gathers share: the combined image, the coordinates, and the reference if there is
// one.
std::optional<Sample> sample_of(ModuleLowering& l, const Instruction& inst, size_t num_fixed) {
  Emitter& e = l.emit();
  const Id type = l.type_of(inst.operands[0]);
  const auto geometry = geometry_of(l, type, false);
  const std::string_view suffix = texel_suffix(l, type);
  if (!geometry || suffix.empty()) return std::nullopt;
  if (bytes_of(l.part_of(image_type(l, type).element)) == 8) {
    l.unsupported("samples of texels of 64 bits");
    return std::nullopt;
  }
  Sample s{*geometry, suffix, {}, std::nullopt, image_operands(inst, num_fixed)};
  Operands at = l.value(inst.operands[1]);
  if (has_reference(inst.op)) s.reference = l.scalar(inst.operands[2]);
  if (is_projective(inst.op)) {
    const Operand last = at.at(geometry->coordinates);
    for (uint32_t i = 0; i < geometry->coordinates; ++i) at[i] = e.div(at[i], last);
    if (s.reference) s.reference = e.div(*s.reference, last);
  }
  s.place = float_place(e, *geometry, l.scalar(inst.operands[0]), at);
  return s;
}

// Lowers a sample. An implicit level comes from the gradients between lanes where the module groups threads
// into quads, and a bias scales the gradients. Choice: so it scales the distance of anisotropic samples, too.
// Otherwise the level is 0, as in GLSL outside of fragment shaders.
void sample(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const bool compares = has_reference(inst.op);
  const auto s = sample_of(l, inst, compares ? 3 : 2);
  if (!s) return;
  Operands sources = s->place;
  std::string name = "tex";
  if (s->extra.lod && !is_constant(l.scalar(*s->extra.lod), 0)) {
    name += ".level";
    sources.push_back(l.scalar(*s->extra.lod));
  } else if (s->extra.gradients) {
    name += ".grad";
    for (const Id gradient : {s->extra.gradients->first, s->extra.gradients->second}) {
      const Operands parts = l.value(gradient);
      sources.insert(sources.end(), parts.begin(), parts.end());
    }
  } else if (is_implicit(inst.op) && has_derivatives(l)) {
    name += ".grad";
    const Operands at(s->place.end() - s->geometry.coordinates, s->place.end());
    const Operand bias =
        s->extra.bias ? l.emit().value("ex2.f32", {l.scalar(*s->extra.bias)}) : constant_f32(1);
    const Operands parts = gradients(l, at, bias);
    sources.insert(sources.end(), parts.begin(), parts.end());
  }
  if (compares) name += ".compare";
  if (s->extra.offset) {
    name += ".offset";
    sources.push_back(packed_offset(l.emit(), l.value(*s->extra.offset)));
  }
  if (compares) sources.push_back(*s->reference);
  name += fmt::format(".{}{}.{}.f32", s->geometry.name, compares ? "" : ".v4", s->suffix);
  if (!compares) return l.set(inst.result, four_words(l, name, sources));
  if (isa::find_op(name) < 0) return l.unsupported("no op " + name);
  l.set(inst.result, {l.emit().fresh(name, sources)});
}

// Returns the level that an implicit sample would read, clamped to the image's levels, and the level before
// clamping. Model: the sampler's bias and limits are ignored, and the level is not rounded for samplers that
// take the nearest level.
void query_lod(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const auto geometry = geometry_of(l, l.type_of(inst.operands[0]), false);
  if (!geometry) return;
  if (geometry->name.find("cube") != std::string_view::npos)
    return l.unsupported("textureQueryLod of a cube");
  if (!has_derivatives(l)) return l.unsupported("textureQueryLod without a derivative group");
  const Operand handle = l.scalar(inst.operands[0]);
  Operands at = l.value(inst.operands[1]);
  at.resize(geometry->coordinates, Operand::value(0));
  const Operands change = gradients(l, at, constant_f32(1));
  constexpr std::string_view kAxes[] = {"width", "height", "depth"};
  Operand along[2] = {constant_f32(0), constant_f32(0)};  // squared lengths in texels, to the right and down
  for (size_t axis = 0; axis < at.size(); ++axis) {
    const Operand size =
        e.value("cvt.rn.f32.u32", {e.fresh(fmt::format("txq.{}.b32", kAxes[axis]), {handle})});
    for (size_t i = 0; i < 2; ++i) {
      const Operand step = e.mul(change[i * at.size() + axis], size);
      along[i] = e.add(along[i], e.mul(step, step));
    }
  }
  const Operand level =
      e.mul(e.value("lg2.f32", {e.value("max.f32", {along[0], along[1]})}), constant_f32(0.5f));
  const Operand last =
      e.add(e.value("cvt.rn.f32.u32", {e.fresh("txq.num_mipmap_levels.b32", {handle})}), constant_f32(-1));
  l.set(inst.result, {e.value("min.f32", {e.value("max.f32", {level, constant_f32(0)}), last}), level});
}

Operands gather_at(ModuleLowering& l, const Sample& s, uint32_t component,
                   const std::optional<Operand>& offset) {
  Operands sources = s.place;
  if (offset) sources.push_back(*offset);
  if (s.reference) sources.push_back(*s.reference);
  const std::string name = fmt::format("tld4{}{}.{}.{}.v4.{}.f32", s.reference ? ".compare" : "",
                                       offset ? ".offset" : "", "rgba"[component], s.geometry.name, s.suffix);
  return four_words(l, name, sources);
}

// Lowers a gather of four texels. With four offsets, it gathers once for each offset and takes the texel (i0,
// j0), which is the last of the four.
void gather(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const auto s = sample_of(l, inst, 3);
  if (!s) return;
  const auto component =
      has_reference(inst.op) ? std::optional<uint32_t>(0) : l.module().constant_u32(inst.operands[2]);
  if (!component || *component > 3) return l.unsupported("a gather of a component that is not a constant");
  if (!s->extra.offsets) {
    std::optional<Operand> offset;
    if (s->extra.offset) offset = packed_offset(l.emit(), l.value(*s->extra.offset));
    return l.set(inst.result, gather_at(l, *s, *component, offset));
  }
  const Operands all = l.value(*s->extra.offsets);
  Operands result;
  for (size_t i = 0; i < 4; ++i)
    result.push_back(
        gather_at(l, *s, *component, packed_offset(l.emit(), {all.at(2 * i), all.at(2 * i + 1)}))[3]);
  l.set(inst.result, std::move(result));
}

constexpr LoweringRow kSampleRows[] = {
    {OpImageSampleExplicitLod, sample, ""},
    {OpImageSampleImplicitLod, sample, ""},
    {OpImageSampleDrefExplicitLod, sample, ""},
    {OpImageSampleDrefImplicitLod, sample, ""},
    {OpImageSampleProjExplicitLod, sample, ""},
    {OpImageSampleProjImplicitLod, sample, ""},
    {OpImageSampleProjDrefExplicitLod, sample, ""},
    {OpImageSampleProjDrefImplicitLod, sample, ""},
    {OpImageQueryLod, query_lod, ""},
    {OpImageGather, gather, ""},
    {OpImageDrefGather, gather, ""},
};

}  // namespace

std::span<const LoweringRow> sample_rows() {
  return kSampleRows;
}

}  // namespace glint::frontend
