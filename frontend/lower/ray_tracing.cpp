// Lowers ray tracing: traces, reports and built-ins, as the shader ABI defines them.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/spirv/known_positions.h"
#include "frontend/spirv/spirv.h"

namespace glint::frontend {
namespace {

using isa::Special;

Operand special(Special first, uint32_t offset = 0) {
  return Operand::of(Special(uint32_t(first) + offset));
}

void trace(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  lower_trace(l, std::span(inst.operands).first(10), l.pointer(inst.operands[10]),
              [&] { l.emit().effect("call.sbt.hit", {}); });
}

// Model: nothing moves. The time of a ray is only a value that shaders read back.
void trace_motion(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.emit().effect("rt.time.set", {l.scalar(inst.operands[10])});
  lower_trace(l, std::span(inst.operands).first(10), l.pointer(inst.operands[11]),
              [&] { l.emit().effect("call.sbt.hit", {}); });
}

void execute_callable(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Emitter& e = l.emit();
  const Operand index = l.scalar(inst.operands[0]), data = local_address(l, l.pointer(inst.operands[1]));
  e.marker(VirtualInst::Kind::SaveLive);
  e.effect("call.sbt.callable", {index, data});
  e.marker(VirtualInst::Kind::RestoreLive);
  forget_after_call(l);
}

// Lowers the end of an any-hit shader. In SPV_NV_ray_tracing the instruction is not a terminator, and code
// that no lane runs follows it. A guard that always holds keeps the block well formed.
void end_any_hit(ModuleLowering& l, const Instruction&, const LoweringRow& row) {
  const Operand always =
      l.emit().fresh("setp.ne.u32", {Operand::of(Special::LaneId), Operand::value(0xffff'ffff)});
  VirtualInst& end = l.emit().effect(row.name32, {});
  end.guard = always.reg;
}

// Makes a structure from its address, which is given in 64 bits or in two words.
void structure_from_address(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands parts = l.value(inst.operands[0]);
  l.set(inst.result, {parts.size() == 2 ? l.emit().value("pack.b64", parts) : parts.at(0)});
}

void report(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
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
  forget_after_call(l);
  l.set(inst.result, {e.fresh("rt.accepted", {})});
}

// Model: the clock has 64 bits, and its upper half is 0.
void read_clock(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
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

// Returns a matrix, GLSL's mat4x3: four columns of three rows. The special registers are numbered row by row.
Operands matrix(Special first) {
  Operands parts;
  for (uint32_t column = 0; column < 4; ++column)
    for (uint32_t row = 0; row < 3; ++row) parts.push_back(special(first, 4 * row + column));
  return parts;
}

using enum spv::Op;
constexpr LoweringRow kRayTracingRows[] = {
    {OpTraceRayKHR, trace, ""},
    {OpTraceRayMotionNV, trace_motion, ""},
    {OpExecuteCallableKHR, execute_callable, ""},
    {OpIgnoreIntersectionNV, end_any_hit, "rt.ignore"},
    {OpTerminateRayNV, end_any_hit, "rt.terminate"},
    {OpConvertUToAccelerationStructureKHR, structure_from_address, ""},
    {OpReportIntersectionKHR, report, ""},
    {OpReadClockKHR, read_clock, ""},
};

}  // namespace

// Returns the address in a register, because SaveLive moves the stack pointer.
Operand local_address(ModuleLowering& l, const Pointer& p) {
  if (p.space != PointerSpace::Local) {
    l.unsupported("a payload that is not in local memory");
    return Operand::value(0);
  }
  return l.emit().in_register(l.emit().value("add.u32", {p.base, Operand::value(uint32_t(p.displacement))}),
                              RegisterClass::B32);
}

Operand attribute_buffers_address(ModuleLowering& l) {
  Pointer attributes;
  attributes.space = PointerSpace::Local;
  attributes.base = Operand::stack_pointer();
  attributes.displacement = l.attribute_buffers();
  return local_address(l, attributes);
}

void forget_after_call(ModuleLowering& l) {
  l.note_store(PointerSpace::Local);
  l.note_store(PointerSpace::Global);
  l.emit().forget();  // A value that is computed again need not be saved.
}

void lower_trace(ModuleLowering& l, std::span<const uint32_t> arguments, const Pointer& payload,
                 const std::function<void()>& finish) {
  Emitter& e = l.emit();
  Operands operands{Operand::of(l.program().new_register(RegisterClass::Predicate))};
  const Operand waits = operands[0];
  for (const Id argument : arguments) {
    const Operands parts = l.value(argument);
    operands.insert(operands.end(), parts.begin(), parts.end());
  }
  operands.push_back(local_address(l, payload));
  operands.push_back(attribute_buffers_address(l));
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
  finish();
  e.effect("rt.end", {});
  e.marker(VirtualInst::Kind::RestoreLive);
  forget_after_call(l);
}

Operands ModuleLowering::load_builtin(spv::BuiltIn builtin, Id type) {
  if (const std::optional<Operands> parts = load_compute_builtin(builtin)) return *parts;
  if (builtin == kHitTriangleVertexPositions) {
    Operands parts;
    for (uint32_t number = 0; number < 9; ++number)
      parts.push_back(emitter_.fresh("rt.corner", {Operand::value(number)}));
    return parts;
  }
  switch (builtin) {
    case spv::BuiltIn::LaunchIdKHR:
      return vector(Special::LaunchX, 3);
    case spv::BuiltIn::LaunchSizeKHR:
      return vector(Special::LaunchSizeX, 3);
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
      // The end of the ray moves with each report, so an intersection shader reads it again each time.
      if (stage() == isa::Stage::Intersection) return {emitter_.fresh("mov.b32", {special(Special::HitT)})};
      return {special(Special::HitT)};
    case spv::BuiltIn::IncomingRayFlagsKHR:
      return {special(Special::RayFlags)};
    case spv::BuiltIn::CullMaskKHR:
      return {special(Special::RayCullMask)};
    case spv::BuiltIn::CurrentRayTimeNV:
      return {emitter_.fresh("rt.time.get", {})};
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
  return kRayTracingRows;
}

}  // namespace glint::frontend
