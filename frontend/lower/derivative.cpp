// Lowers derivatives of compute shaders: differences between the lanes of a quad
// (SPV_NV_compute_shader_derivatives).
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/derivative.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "frontend/lower/scan.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

bool asks_for(ModuleLowering& l, spv::Capability wanted) {
  const auto& all = l.module().capabilities;
  return std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.first == wanted; });
}

// Returns the distance in lanes between vertical neighbours of a quad. Where they are not in one warp, it
// returns nothing and reports the module as unsupported.
std::optional<uint32_t> row_distance(ModuleLowering& l) {
  if (asks_for(l, spv::Capability::ComputeDerivativeGroupLinearNV))
    return 2;  // a quad is four consecutive threads
  if (!asks_for(l, spv::Capability::ComputeDerivativeGroupQuadsNV)) {
    l.unsupported("a derivative without a derivative group");
    return std::nullopt;
  }
  // Model: threads are assigned to warps by their index, so quads are whole only in blocks of these widths.
  const uint32_t width = l.program().local_size[0];
  if (width == 2 || width == 4 || width == 8 || width == 16) return width;
  l.unsupported("derivatives in quads of blocks whose width is not 2, 4, 8 or 16");
  return std::nullopt;
}

// Returns right - left, or below - above. Fine derivatives use the lane's own row or column, and coarse ones
// use the first of the quad.
Operand difference(ModuleLowering& l, Part part, const Operand& x, uint32_t distance,
                   std::optional<uint32_t> other_axis) {
  Emitter& e = l.emit();
  const Operand self = Operand::of(isa::Special::LaneId);
  const uint32_t both = distance | other_axis.value_or(0);
  const Operand first = e.value("and.b32", {self, Operand::value(~both)});
  const Operand second = e.value("or.b32", {first, Operand::value(distance)});
  const Operand near = scan::from_lane(l, part, x, first), far = scan::from_lane(l, part, x, second);
  return typed(e, "sub.rn.f32", part, {far, near});
}

enum class Axis : uint8_t { X, Y, Both };

Axis axis_of(spv::Op op) {
  if (op == OpDPdx || op == OpDPdxFine || op == OpDPdxCoarse) return Axis::X;
  return op == OpDPdy || op == OpDPdyFine || op == OpDPdyCoarse ? Axis::Y : Axis::Both;
}

// Choice: derivatives that are neither fine nor coarse are fine.
void derivative(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const auto rows = row_distance(l);
  if (!rows) return;
  const bool is_coarse = inst.op == OpDPdxCoarse || inst.op == OpDPdyCoarse || inst.op == OpFwidthCoarse;
  const Axis axis = axis_of(inst.op);
  const Part part = l.part_of(inst.type);
  Operands result;
  for (const Operand& x : Operands(l.value(inst.operands[0]))) {
    const auto along = [&](uint32_t distance, uint32_t other) {
      return difference(l, part, x, distance, is_coarse ? std::optional(other) : std::nullopt);
    };
    if (axis != Axis::Both) {
      result.push_back(axis == Axis::X ? along(1, *rows) : along(*rows, 1));
      continue;
    }
    const Operand dx = along(1, *rows), dy = along(*rows, 1);
    result.push_back(typed(l.emit(), "add.rn.f32", part,
                           {typed(l.emit(), "abs.f32", part, {dx}), typed(l.emit(), "abs.f32", part, {dy})}));
  }
  l.set(inst.result, std::move(result));
}

constexpr LoweringRow kDerivativeRows[] = {
    {OpDPdx, derivative, ""},       {OpDPdy, derivative, ""},       {OpFwidth, derivative, ""},
    {OpDPdxFine, derivative, ""},   {OpDPdyFine, derivative, ""},   {OpFwidthFine, derivative, ""},
    {OpDPdxCoarse, derivative, ""}, {OpDPdyCoarse, derivative, ""}, {OpFwidthCoarse, derivative, ""},
};

}  // namespace

bool has_derivatives(ModuleLowering& l) {
  return asks_for(l, spv::Capability::ComputeDerivativeGroupLinearNV) ||
         asks_for(l, spv::Capability::ComputeDerivativeGroupQuadsNV);
}

Operands gradients(ModuleLowering& l, const Operands& coordinates, const Operand& scale) {
  Operands result;
  const auto rows = row_distance(l);
  if (!rows) return Operands(2 * coordinates.size(), Operand::value(0));
  for (const uint32_t distance : {1u, *rows})
    for (const Operand& x : coordinates)
      result.push_back(l.emit().mul(difference(l, Part::Float32, x, distance, std::nullopt), scale));
  return result;
}

std::span<const LoweringRow> derivative_rows() {
  return kDerivativeRows;
}

}  // namespace glint::frontend
