// Lowers the instruction sets of SPV_AMD_*: minima and maxima of three, exchanges between lanes, faces of
// cubes.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spirv/unified1/AMD_gcn_shader.h>
#include <spirv/unified1/AMD_shader_ballot.h>
#include <spirv/unified1/AMD_shader_trinary_minmax.h>

#include "frontend/lower/lowering.h"
#include "frontend/lower/scan.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

Operand self() {
  return Operand::of(isa::Special::LaneId);
}

// Calls f(part, the arguments' scalars) for each part of the result. A scalar argument repeats.
template <class F>
void each_result_part(ModuleLowering& l, const Instruction& inst, size_t num_arguments, F&& f) {
  std::vector<Operands> arguments;
  for (size_t i = 0; i < num_arguments; ++i) arguments.push_back(l.value(inst.operands.at(2 + i)));
  const Part part = l.part_of(inst.type);
  Operands result;
  for (size_t i = 0; i < arguments[0].size(); ++i) {
    Operands scalars;
    for (const Operands& argument : arguments) scalars.push_back(argument[argument.size() == 1 ? 0 : i]);
    result.push_back(f(part, scalars));
  }
  l.set(inst.result, std::move(result));
}

// Lowers minima, maxima and medians of three. The median is max(min(x, y), min(max(x, y), z)).
bool trinary(ModuleLowering& l, const Instruction& inst) {
  const uint32_t function = inst.operands[1];
  if (function < AMD_shader_trinary_minmaxFMin3AMD || function > AMD_shader_trinary_minmaxSMid3AMD)
    return false;
  constexpr std::string_view kTypes[] = {"f32", "u32", "s32"};
  const std::string_view type = kTypes[(function - 1) % 3];
  const std::string least = fmt::format("min.{}", type), most = fmt::format("max.{}", type);
  each_result_part(l, inst, 3, [&](Part part, const Operands& x) {
    const auto op = [&](const std::string& name, const Operand& a, const Operand& b) {
      return typed(l.emit(), name, part, {a, b});
    };
    if (function <= AMD_shader_trinary_minmaxSMin3AMD) return op(least, op(least, x[0], x[1]), x[2]);
    if (function <= AMD_shader_trinary_minmaxSMax3AMD) return op(most, op(most, x[0], x[1]), x[2]);
    return op(most, op(least, x[0], x[1]), op(least, op(most, x[0], x[1]), x[2]));
  });
  return true;
}

// Returns the first argument's value in that lane, or 0 if the lane does not execute.
void from_lane(ModuleLowering& l, const Instruction& inst, const Operand& lane) {
  Emitter& e = l.emit();
  const Operand bit =
      e.value("and.b32", {e.value("shr.u32", {e.fresh("activemask.b32", {}), lane}), word(1)});
  const Operand executes = e.value("setp.ne.u32", {bit, word(0)});
  each_result_part(l, inst, 1, [&](Part part, const Operands& x) {
    return e.select(executes, scan::from_lane(l, part, x[0], lane), word(0));
  });
}

// Returns the source lane of a swizzle: offset[self & 3] is the lane within the group of four.
Operand swizzled_lane(ModuleLowering& l, const Operands& offset) {
  Emitter& e = l.emit();
  const Operand at = e.value("and.b32", {self(), word(3)});
  Operand lane = offset.at(0);
  for (uint32_t i = 1; i < 4; ++i) lane = e.select(e.value("setp.eq.u32", {at, word(i)}), offset.at(i), lane);
  return e.value("or.b32", {e.value("and.b32", {self(), word(~3u)}), lane});
}

// Returns ((self & and) | or) ^ xor, within groups of 32 lanes.
Operand masked_lane(ModuleLowering& l, const Operands& mask) {
  Emitter& e = l.emit();
  const Operand lane = e.value("or.b32", {e.value("and.b32", {self(), mask.at(0)}), mask.at(1)});
  return e.value("and.b32", {e.value("xor.b32", {lane, mask.at(2)}), word(31)});
}

bool ballot(ModuleLowering& l, const Instruction& inst) {
  Emitter& e = l.emit();
  switch (inst.operands[1]) {
    case AMD_shader_ballotSwizzleInvocationsAMD:
      from_lane(l, inst, swizzled_lane(l, l.value(inst.operands.at(3))));
      return true;
    case AMD_shader_ballotSwizzleInvocationsMaskedAMD:
      from_lane(l, inst, masked_lane(l, l.value(inst.operands.at(3))));
      return true;
    case AMD_shader_ballotWriteInvocationAMD: {
      const Operand chosen = e.value("setp.eq.u32", {self(), l.word(inst.operands.at(4))});
      each_result_part(l, inst, 2, [&](Part, const Operands& x) { return e.select(chosen, x[1], x[0]); });
      return true;
    }
    case AMD_shader_ballotMbcntAMD: {  // counts bits of the lanes below, among 32
      const Operand lanes = e.value("cvt.u32.u64", {l.scalar(inst.operands.at(2))});
      l.set(inst.result,
            {e.value("popc.b32", {e.value("and.b32", {lanes, Operand::of(isa::Special::LanemaskLt)})})});
      return true;
    }
    default:
      return false;
  }
}

// Holds a cube's face and coordinates (Vulkan, "Cube Map Face Selection"): z takes precedence over y, and y
// over x. Faces are numbered from +x, -x, +y.
struct Cube {
  Operand face, s, t, major;
};
Cube cube_of(Emitter& e, const Operands& p) {
  const auto size = [&](int axis) { return e.value("abs.f32", {p.at(size_t(axis))}); };
  const auto minus = [&](int axis) { return e.value("neg.f32", {p.at(size_t(axis))}); };
  const auto at_least = [&](int a, int b) { return e.value("setp.ge.f32", {size(a), size(b)}); };
  const auto is_negative = [&](int axis) {
    return e.value("setp.lt.f32", {p.at(size_t(axis)), constant_f32(0)});
  };
  const Operand z = e.value("and.pred", {at_least(2, 0), at_least(2, 1)}), y = at_least(1, 0);
  const auto choose = [&](const Operand& if_z, const Operand& if_y, const Operand& if_x) {
    return e.select(z, if_z, e.select(y, if_y, if_x));
  };
  const auto face = [&](int axis) {
    return e.select(is_negative(axis), constant_f32(float(2 * axis + 1)), constant_f32(float(2 * axis)));
  };
  return {choose(face(2), face(1), face(0)),
          choose(e.select(is_negative(2), minus(0), p[0]), p[0], e.select(is_negative(0), p[2], minus(2))),
          choose(minus(1), e.select(is_negative(1), minus(2), p[2]), minus(1)),
          choose(size(2), size(1), size(0))};
}

bool gcn(ModuleLowering& l, const Instruction& inst) {
  Emitter& e = l.emit();
  // Model: the clock has 64 bits, and its upper half is 0.
  if (inst.operands[1] == AMD_gcn_shaderTimeAMD) {
    l.set(inst.result, {e.value("cvt.u64.u32", {e.fresh("mov.b32", {Operand::of(isa::Special::Clock)})})});
    return true;
  }
  if (inst.operands[1] != AMD_gcn_shaderCubeFaceIndexAMD &&
      inst.operands[1] != AMD_gcn_shaderCubeFaceCoordAMD)
    return false;
  const Cube cube = cube_of(e, l.value(inst.operands.at(2)));
  if (inst.operands[1] == AMD_gcn_shaderCubeFaceIndexAMD) {
    l.set(inst.result, {cube.face});
    return true;
  }
  const auto coordinate = [&](const Operand& x) {
    return e.add(e.div(x, e.mul(constant_f32(2), cube.major)), constant_f32(0.5f));
  };
  l.set(inst.result, {coordinate(cube.s), coordinate(cube.t)});
  return true;
}

}  // namespace

bool lower_vendor_set(ModuleLowering& l, const std::string& set, const Instruction& inst) {
  if (set == "SPV_AMD_shader_trinary_minmax") return trinary(l, inst);
  if (set == "SPV_AMD_shader_ballot") return ballot(l, inst);
  return set == "SPV_AMD_gcn_shader" && gcn(l, inst);
}

}  // namespace glint::frontend
