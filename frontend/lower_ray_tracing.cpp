// Ray tracing: traces, reports and built-ins, as the shader ABI lays them down.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "frontend/lower.h"
#include "frontend/spirv.h"

namespace glint::frontend {
namespace {

using isa::Special;

Operand special(Special first, uint32_t offset = 0) {
  return Operand::of(Special(uint32_t(first) + offset));
}

// The lane's local address that a pointer means. In a register: SaveLive moves the stack pointer.
Operand local_address(Lowering& l, const Pointer& p) {
  if (p.place != Place::Local) {
    l.unsupported("a payload that is not in local memory");
    return Operand::value(0);
  }
  return l.emit().in_register(l.emit().value("add.u32", {p.base, Operand::value(uint32_t(p.displacement))}),
                              RegisterClass::B32);
}

// docs/abi.md, Calls and rays.
void trace(Lowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const auto& args = inst.operands;
  Operands operands{Operand::of(l.program().new_register(RegisterClass::Predicate))};
  const Operand waits = operands[0];
  for (size_t i = 0; i < 10;
       ++i) {  // structure, flags, mask, offset, stride, miss, origin, t min, direction, t max
    const Operands parts = l.value(args[i]);
    operands.insert(operands.end(), parts.begin(), parts.end());
  }
  operands.push_back(local_address(l, l.pointer(args[10])));
  Pointer attributes;
  attributes.place = Place::Local;
  attributes.base = Operand::stack_pointer();
  attributes.displacement = l.attribute_buffers();
  operands.push_back(local_address(l, attributes));
  const BlockId loop = e.new_block("trace_loop"), candidates = e.new_block("trace_candidates"),
                done = e.new_block("trace_done");
  e.marker(VirtualInst::Kind::SaveLive);
  e.effect("rt.trace", std::move(operands));
  e.push_reconvergence(done);
  e.place(loop);
  e.branch_if(waits, false, done);
  e.place(candidates);
  e.effect("call.sbt.candidate", {});
  e.effect("rt.resume", {waits});
  e.branch(loop);
  e.place(done);
  e.effect("join", {});
  e.effect("call.sbt.hit", {});
  e.effect("rt.end", {});
  e.marker(VirtualInst::Kind::RestoreLive);
  l.note_store(Place::Local);
  l.note_store(Place::Global);
  e.forget();  // what is computed again need not be saved
}

void report(Lowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Operand waits = Operand::of(l.program().new_register(RegisterClass::Predicate));
  const BlockId any_hit = e.new_block("report_any_hit"), decided = e.new_block("report_decided");
  l.hand_over_attributes();
  e.effect("rt.report", {waits, l.scalar(inst.operands[0]), l.scalar(inst.operands[1])});
  e.push_reconvergence(decided);
  e.branch_if(waits, false, decided);
  e.place(any_hit);
  e.marker(VirtualInst::Kind::SaveLive);
  e.effect("call.sbt.anyhit", {});
  e.marker(VirtualInst::Kind::RestoreLive);
  e.place(decided);
  e.effect("join", {});
  l.note_store(Place::Local);
  l.note_store(Place::Global);
  e.forget();
  l.set(inst.result, {e.fresh("rt.accepted", {})});
}

// Model: a 64-bit clock whose upper half is 0.
void read_clock(Lowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand low = l.emit().fresh("mov.b32", {Operand::of(Special::Clock)});
  if (l.layout().num_parts(inst.type) == 2)
    l.set(inst.result, {low, Operand::value(0)});
  else
    l.set(inst.result, {l.emit().value("cvt.u64.u32", {low})});
}

Operands vector(Special first, uint32_t count) {
  Operands parts;
  for (uint32_t i = 0; i < count; ++i) parts.push_back(special(first, i));
  return parts;
}

// mat4x3 in GLSL: four columns of three rows; the specials are row by row.
Operands matrix(Special first) {
  Operands parts;
  for (uint32_t column = 0; column < 4; ++column)
    for (uint32_t row = 0; row < 3; ++row) parts.push_back(special(first, 4 * row + column));
  return parts;
}

// Compute built-ins follow from the launch id, which is the global invocation id.
Operands compute_builtin(Lowering& l, spv::BuiltIn builtin) {
  Operands parts;
  for (uint32_t i = 0; i < 3; ++i) {
    const Operand size = Operand::value(l.program().local_size[i]);
    const bool counts_groups = builtin == spv::BuiltIn::NumWorkgroups;
    const Operand of = special(counts_groups ? Special::LaunchSizeX : Special::LaunchX, i);
    parts.push_back(
        l.emit().value(builtin == spv::BuiltIn::LocalInvocationId ? "rem.u32" : "div.u32", {of, size}));
  }
  return parts;
}

using enum spv::Op;
constexpr LoweringRow kRows[] = {
    {OpTraceRayKHR, trace, ""},
    {OpReportIntersectionKHR, report, ""},
    {OpReadClockKHR, read_clock, ""},
};

}  // namespace

Operands Lowering::load_builtin(spv::BuiltIn builtin, Id type) {
  switch (builtin) {
    case spv::BuiltIn::LaunchIdKHR:
    case spv::BuiltIn::GlobalInvocationId:
      return vector(Special::LaunchX, 3);
    case spv::BuiltIn::LaunchSizeKHR:
      return vector(Special::LaunchSizeX, 3);
    case spv::BuiltIn::NumWorkgroups:
    case spv::BuiltIn::WorkgroupId:
    case spv::BuiltIn::LocalInvocationId:
      return compute_builtin(*this, builtin);
    case spv::BuiltIn::WorldRayOriginKHR:
      return vector(Special::RayOriginX, 3);
    case spv::BuiltIn::WorldRayDirectionKHR:
      return vector(Special::RayDirectionX, 3);
    case spv::BuiltIn::ObjectRayOriginKHR:
      return vector(Special::ObjectOriginX, 3);
    case spv::BuiltIn::ObjectRayDirectionKHR:
      return vector(Special::ObjectDirectionX, 3);
    case spv::BuiltIn::ObjectToWorldKHR:
      return matrix(Special::ObjectToWorld0);
    case spv::BuiltIn::WorldToObjectKHR:
      return matrix(Special::WorldToObject0);
    case spv::BuiltIn::RayTminKHR:
      return {special(Special::RayTmin)};
    case spv::BuiltIn::RayTmaxKHR:
    case spv::BuiltIn::HitTNV:
      // The end of the ray moves with each report, so an intersection shader reads it anew each time.
      if (stage() == isa::Stage::Intersection) return {emitter_.fresh("mov.b32", {special(Special::HitT)})};
      return {special(Special::HitT)};
    case spv::BuiltIn::IncomingRayFlagsKHR:
      return {special(Special::RayFlags)};
    case spv::BuiltIn::HitKindKHR:
      return {special(Special::HitKind)};
    case spv::BuiltIn::PrimitiveId:
      return {special(Special::HitPrimitive)};
    case spv::BuiltIn::InstanceId:
      return {special(Special::HitInstance)};
    case spv::BuiltIn::InstanceCustomIndexKHR:
      return {special(Special::HitCustomIndex)};
    case spv::BuiltIn::RayGeometryIndexKHR:
      return {special(Special::HitGeometry)};
    default:
      unsupported("built-in variable " + name_of_builtin(uint32_t(builtin)));
      return Operands(layout_.num_parts(type), Operand::value(0));
  }
}

std::span<const LoweringRow> ray_tracing_rows() {
  return kRows;
}

}  // namespace glint::frontend
