// Images: reads and writes of storage images, and sampling at the base level.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower.h"

namespace glint::frontend {
namespace {

bool is_plain_2d(Lowering& l, Id type_id) {
  const Type* type = &l.module().type(type_id);
  if (type->kind == Type::Kind::SampledImage) type = &l.module().type(type->element);
  if (type->kind == Type::Kind::Image && type->dim == spv::Dim::Dim2D && type->count == 0) return true;
  l.unsupported("images that are not 2D");
  return false;
}

void read(Lowering& l, const Instruction& inst, const LoweringRow&) {
  if (!is_plain_2d(l, l.type_of(inst.operands[0]))) return;
  const Operand handle = l.scalar(inst.operands[0]);
  const Operands at = l.value(inst.operands[1]);
  Operands texel;
  for (int i = 0; i < 4; ++i) texel.push_back(Operand::of(l.program().new_register(RegisterClass::B32)));
  Operands operands = texel;
  operands.insert(operands.end(), {handle, at[0], at[1]});
  l.emit().effect("suld.p.2d.v4.b32.trap", std::move(operands));
  texel.resize(l.layout().num_parts(inst.type));
  l.set(inst.result, std::move(texel));
}

void write(Lowering& l, const Instruction& inst, const LoweringRow&) {
  if (!is_plain_2d(l, l.type_of(inst.operands[0]))) return;
  const Operands at = l.value(inst.operands[1]), texel = l.value(inst.operands[2]);
  Operands operands{l.scalar(inst.operands[0]), at[0], at[1]};
  for (size_t i = 0; i < 4; ++i) operands.push_back(i < texel.size() ? texel[i] : Operand::value(0));
  l.emit().effect("sust.p.2d.v4.b32.trap", std::move(operands));
}

// Model: textures have one level, so the level of detail and gradients do not matter.
void sample(Lowering& l, const Instruction& inst, const LoweringRow&) {
  if (!is_plain_2d(l, l.type_of(inst.operands[0]))) return;
  const uint32_t extras = inst.operands.size() > 2 ? inst.operands[2] : 0;
  const uint32_t known = uint32_t(spv::ImageOperandsMask::Lod) | uint32_t(spv::ImageOperandsMask::Grad);
  if (extras & ~known) l.unsupported("image operands " + std::to_string(extras));
  if (l.layout().parts(inst.type)[0] != Part::Float32) l.unsupported("sampling of integer images");
  const Operands at = l.value(inst.operands[1]);
  Operands texel;
  for (int i = 0; i < 4; ++i) texel.push_back(Operand::of(l.program().new_register(RegisterClass::B32)));
  Operands operands = texel;
  operands.insert(operands.end(), {l.scalar(inst.operands[0]), at[0], at[1]});
  l.emit().effect("tex.2d.v4.f32.f32", std::move(operands));
  l.set(inst.result, std::move(texel));
}

using enum spv::Op;
constexpr LoweringRow kRows[] = {
    {OpImageRead, read, ""},
    {OpImageWrite, write, ""},
    {OpImageSampleExplicitLod, sample, ""},
};

}  // namespace

std::span<const LoweringRow> image_rows() {
  return kRows;
}

}  // namespace glint::frontend
