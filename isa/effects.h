// Says what each effect is to the executor, the timing, the verifier and the compiler: one row per effect.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "isa/stage.h"

namespace glint::isa {

// Names what the machine must do after the handler ran. None means that the handler did everything.
enum class Effect : uint8_t {
  None,
  // OpRow::memory describes Load, Store and Atomic. Their addresses are in Warp::access.
  Load,
  Store,
  Atomic,  // OpRow::detail is its kind (isa/atomic.h)
  // OpRow::image describes Texture, SurfaceLoad and SurfaceStore. access.address is the handle.
  Texture,
  SurfaceLoad,
  SurfaceStore,
  SurfaceAtomic,      // read-modify-write of a texel by OpRow::atomic
  ImageQuery,         // asks for properties of the image; accesses no memory
  Branch,             // to Inst::imm, for the lanes of exec
  BranchIndexed,      // brx.idx: to Inst::imm + operand 0, in a table of branches
  Call,               // to the function at Inst::imm; `ret` comes back
  PushReconvergence,  // ssy: lanes will meet at Inst::imm
  Join,               // lanes wait for the others of the innermost ssy that names this place
  Exit,               // lanes end
  Return,             // lanes return from a function or a shader call
  Trap,               // raises a fault
  // The ops call.sbt.* call shaders indirectly through the binding table.
  CallCandidate,
  CallAnyHit,
  CallHit,
  CallCallable,
  CallFunction,  // to the function whose number operand 0 holds; `ret` comes back
  // rt.trace and rt.resume give rays to the RT unit. The answer goes to the predicate of operand slot 0.
  Trace,  // OpRow::detail is its kind (isa/hit_object.h)
  Resume,
  Report,        // rt.report
  Accepted,      // rt.accepted
  Ignore,        // rt.ignore
  Terminate,     // rt.terminate
  EndTrace,      // rt.end
  Query,         // rq.*: OpRow::detail says which (isa/ray_query.h)
  QueryProceed,  // rq.proceed: gives rays to the RT unit
  HitObject,     // ho.*: OpRow::detail says which (isa/hit_object.h)
  Reorder,       // *.reorder: a core may regroup lanes here; OpRow::detail says which (isa/hit_object.h)
  Barrier,       // bar.*: warps of a block wait for each other; OpRow::detail is the kind (isa/barrier.h)
  // print and print.part print a message of Program::messages with its words.
  Print,
  PrintPart,
  Fence,  // membar, fence, bar.warp.sync: orders memory accesses; OpRow::detail is the scope (isa/barrier.h)
  // cp.async copies from the global addresses that the handler forms to the shared addresses of operand 0,
  // while the warp goes on. OpRow::memory describes a lane's copy in global memory.
  Copy,
  CopyGroup,  // cp.async.*_group: ends a group of copies, or waits for groups (isa/async_copy.h)
  Mbarrier,   // mbarrier.*: changes or asks a barrier in shared memory; OpRow::detail is its kind
              // (isa/mbarrier.h)
  Yield,      // lanes that wait here may give way to others of their warp (exec/control.cpp)
  Count
};

// Names the families of effects. Each is one part of the executor (exec/executor.h).
enum class EffectFamily : uint8_t {
  None,
  Memory,
  Image,
  Control,
  ShaderCall,  // runs other programs, which use all registers and predicates except %r0 (docs/abi.md)
  Trace,
  Query,
  HitObject,
  Reorder,
  Barrier,
  Print
};

// Says what ends an instruction.
enum class Finish : uint8_t {
  Fixed,       // a fixed time has passed since issue
  Memory,      // the memory has answered
  Rays,        // the RT unit has answered
  Control,     // a fixed time has passed, in which the warp does not issue
  CallRecord,  // what ends Control, and then the read of the record of the binding table
  Barrier,     // the other warps have come; a bar.arrive ends as Control does
  Fence,       // the warp's earlier accesses are done, and then a fixed time has passed
  Copies,      // the groups of copies that it waits for are done, and then a fixed time has passed
  Reorder,     // what ends Control, or what a core that regroups lanes says
};

// Says where the lanes go that execute the instruction.
enum class Flow : uint8_t {
  Next,    // to the next instruction; a call comes back to it
  Jump,    // to Inst::imm
  Table,   // to an entry of the table of branches at Inst::imm
  Return,  // back to the caller of the function or the shader
  Exit,    // to their end
  Trap     // to a fault
};

// Says which trace the instruction belongs to.
enum class TraceUse : uint8_t {
  None,
  Opens,    // it begins a trace
  Inside,   // a trace that this shader has begun
  Closes,   // the innermost trace that this shader has begun, which ends
  OfCaller  // the trace that runs this shader
};

// Says what the compiler may do with an instruction. Accesses that may meet in memory keep their order.
struct Freedom {
  bool may_drop = false;  // where nothing reads its results
  bool may_move = false;  // to another place in its block
  bool may_copy = false;  // to every turn of an unrolled loop
};
inline constexpr Freedom kPure{true, true, true};

struct EffectRow {
  Effect effect = Effect::None;
  EffectFamily family = EffectFamily::None;
  Finish finish = Finish::Fixed;
  Flow flow = Flow::Next;
  TraceUse trace = TraceUse::None;
  bool reads_memory = false, writes_memory = false;  // at the addresses that the handler forms
  bool takes_guard = true;                           // false: it moves all lanes of the warp
  Freedom freedom = {};
  StageSet stages = kAllStages;  // in which shaders it means something (docs/abi.md; Vulkan's models)
};

// These are the stages that may trace rays.
inline constexpr StageSet kTracingStages{Stage::RayGeneration, Stage::ClosestHit, Stage::Miss};

// Model: an op of the constant bank ends after a fixed time, whatever its effect says, and a fence of the
// warp ends as Control does (core/issue_table.cpp).
inline constexpr EffectRow kEffects[] = {
    {.effect = Effect::None, .freedom = kPure},
    {.effect = Effect::Load,
     .family = EffectFamily::Memory,
     .finish = Finish::Memory,
     .reads_memory = true,
     .freedom = kPure},
    {.effect = Effect::Store,
     .family = EffectFamily::Memory,
     .finish = Finish::Memory,
     .writes_memory = true,
     .freedom = {.may_move = true, .may_copy = true}},
    {.effect = Effect::Atomic,
     .family = EffectFamily::Memory,
     .finish = Finish::Memory,
     .reads_memory = true,
     .writes_memory = true,
     .freedom = {.may_move = true, .may_copy = true}},
    {.effect = Effect::Texture,
     .family = EffectFamily::Image,
     .finish = Finish::Memory,
     .reads_memory = true,
     .freedom = kPure},
    {.effect = Effect::SurfaceLoad,
     .family = EffectFamily::Image,
     .finish = Finish::Memory,
     .reads_memory = true,
     .freedom = kPure},
    {.effect = Effect::SurfaceStore,
     .family = EffectFamily::Image,
     .finish = Finish::Memory,
     .writes_memory = true,
     .freedom = {.may_move = true, .may_copy = true}},
    {.effect = Effect::SurfaceAtomic,
     .family = EffectFamily::Image,
     .finish = Finish::Memory,
     .reads_memory = true,
     .writes_memory = true},
    {.effect = Effect::ImageQuery, .family = EffectFamily::Image},
    {.effect = Effect::Branch,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .flow = Flow::Jump},
    {.effect = Effect::BranchIndexed,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .flow = Flow::Table},
    {.effect = Effect::Call, .family = EffectFamily::Control, .finish = Finish::Control},
    // ssy only names the place where lanes meet again, and the warp goes on with the next instruction.
    {.effect = Effect::PushReconvergence, .family = EffectFamily::Control, .takes_guard = false},
    {.effect = Effect::Join,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .takes_guard = false},
    {.effect = Effect::Exit,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .flow = Flow::Exit,
     .stages = {Stage::RayGeneration, Stage::Compute}},
    {.effect = Effect::Return,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .flow = Flow::Return},
    {.effect = Effect::Trap, .family = EffectFamily::Control, .finish = Finish::Control, .flow = Flow::Trap},
    {.effect = Effect::CallCandidate,
     .family = EffectFamily::ShaderCall,
     .finish = Finish::CallRecord,
     .trace = TraceUse::Inside,
     .stages = kTracingStages},
    {.effect = Effect::CallAnyHit,
     .family = EffectFamily::ShaderCall,
     .finish = Finish::CallRecord,
     .trace = TraceUse::OfCaller,
     .stages = {Stage::Intersection}},
    {.effect = Effect::CallHit,
     .family = EffectFamily::ShaderCall,
     .finish = Finish::CallRecord,
     .trace = TraceUse::Inside,
     .stages = kTracingStages},
    {.effect = Effect::CallCallable,
     .family = EffectFamily::ShaderCall,
     .finish = Finish::CallRecord,
     .stages = {Stage::RayGeneration, Stage::ClosestHit, Stage::Miss, Stage::Callable}},
    {.effect = Effect::CallFunction,
     .family = EffectFamily::ShaderCall,
     .finish = Finish::Control,
     .stages = {Stage::Compute}},
    {.effect = Effect::Trace,
     .family = EffectFamily::Trace,
     .finish = Finish::Rays,
     .trace = TraceUse::Opens,
     .stages = kTracingStages},
    {.effect = Effect::Resume,
     .family = EffectFamily::Trace,
     .finish = Finish::Rays,
     .trace = TraceUse::Inside,
     .stages = kTracingStages},
    {.effect = Effect::Report,
     .family = EffectFamily::Trace,
     .trace = TraceUse::OfCaller,
     .stages = {Stage::Intersection}},
    {.effect = Effect::Accepted,
     .family = EffectFamily::Trace,
     .trace = TraceUse::OfCaller,
     .freedom = {.may_drop = true},
     .stages = {Stage::Intersection}},
    {.effect = Effect::Ignore,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .flow = Flow::Return,
     .stages = {Stage::AnyHit}},
    {.effect = Effect::Terminate,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .flow = Flow::Return,
     .stages = {Stage::AnyHit}},
    {.effect = Effect::EndTrace,
     .family = EffectFamily::Trace,
     .trace = TraceUse::Closes,
     .takes_guard = false,
     .stages = kTracingStages},
    {.effect = Effect::Query, .family = EffectFamily::Query},
    {.effect = Effect::QueryProceed, .family = EffectFamily::Query, .finish = Finish::Rays},
    // Each op has its own stages (isa/hit_object.h).
    {.effect = Effect::HitObject, .family = EffectFamily::HitObject},
    {.effect = Effect::Reorder,
     .family = EffectFamily::Reorder,
     .finish = Finish::Reorder,
     .takes_guard = false},
    {.effect = Effect::Barrier,
     .family = EffectFamily::Barrier,
     .finish = Finish::Barrier,
     .freedom = {.may_copy = true},
     .stages = {Stage::Compute}},
    {.effect = Effect::Print, .family = EffectFamily::Print},
    {.effect = Effect::PrintPart, .family = EffectFamily::Print},
    {.effect = Effect::Fence,
     .family = EffectFamily::Control,
     .finish = Finish::Fence,
     .freedom = {.may_copy = true}},
    {.effect = Effect::Copy,
     .family = EffectFamily::Memory,
     .finish = Finish::Memory,
     .reads_memory = true,
     .freedom = {.may_copy = true},
     .stages = {Stage::Compute}},
    {.effect = Effect::CopyGroup,
     .family = EffectFamily::Control,
     .finish = Finish::Copies,
     .freedom = {.may_copy = true},
     .stages = {Stage::Compute}},
    {.effect = Effect::Mbarrier,
     .family = EffectFamily::Memory,
     .finish = Finish::Memory,
     .reads_memory = true,
     .writes_memory = true,
     .stages = {Stage::Compute}},
    {.effect = Effect::Yield,
     .family = EffectFamily::Control,
     .finish = Finish::Control,
     .freedom = {.may_copy = true}},
};
static_assert(std::size(kEffects) == size_t(Effect::Count), "every effect has a row");
static_assert(
    [] {
      for (size_t i = 0; i < std::size(kEffects); ++i)
        if (kEffects[i].effect != Effect(i)) return false;
      return true;
    }(),
    "the rows have the order of the enum");

constexpr const EffectRow& effect_row(Effect e) {
  return kEffects[size_t(e)];
}
constexpr bool is_shader_call(Effect e) {
  return effect_row(e).family == EffectFamily::ShaderCall;
}
constexpr bool only_writes_memory(Effect e) {
  return effect_row(e).writes_memory && !effect_row(e).reads_memory;
}
// Returns true for effects after which the lanes execute no further instruction of their function.
constexpr bool ends_lanes(Effect e) {
  const Flow flow = effect_row(e).flow;
  return flow == Flow::Return || flow == Flow::Exit || flow == Flow::Trap;
}
// Returns true for effects that end a block of the compiler, when there is no guard. brx.idx does not,
// because its table of branches follows it, and the compiler goes on behind a trap.
constexpr bool ends_block(Effect e) {
  const Flow flow = effect_row(e).flow;
  return flow == Flow::Jump || flow == Flow::Return || flow == Flow::Exit;
}
// Returns true for effects that make sense only while a trace of the warp is open.
constexpr bool needs_trace(Effect e) {
  const TraceUse use = effect_row(e).trace;
  return use != TraceUse::None && use != TraceUse::Opens;
}

}  // namespace glint::isa
