// Instruction execution: guards, control flow, and the way to the families of effects.
// SPDX-License-Identifier: Apache-2.0
#include "core/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/check.h"

namespace glint::core {

using isa::Effect;

std::array<uint32_t, 3> launch_id(const World& world, uint32_t warp_index, int lane) {
  const uint64_t index = uint64_t(warp_index) * kLanes + uint64_t(lane);
  const auto& size = world.launch_size;
  return {uint32_t(index % size[0]), uint32_t(index / size[0] % size[1]), uint32_t(index / size[0] / size[1])};
}

std::string Fault::to_string() const {
  return fmt::format("{}: fault: {}\n  note: launch id ({}, {}, {})", place, what, launch_id[0], launch_id[1], launch_id[2]);
}

Fault no_end_in_sight(const World& world, const WarpContext& warp, uint32_t pc, uint64_t instruction_budget) {
  const int lane = warp.simt.active ? std::countr_zero(warp.simt.active) : 0;
  return {fmt::format("no end in sight: the warp has executed more than {} instructions", instruction_budget),
          world.image->place_of(pc), launch_id(world, warp.warp_index, lane)};
}

Executor::Executor(const World& world)
    : world_(world),
      reads_clock_(std::any_of(world.image->shaders.begin(), world.image->shaders.end(), [](const Shader& shader) {
        return shader.specials_used[size_t(isa::Special::Clock)];
      })) {}

uint32_t Executor::num_warps() const {
  const uint64_t threads = uint64_t(world_.launch_size[0]) * world_.launch_size[1] * world_.launch_size[2];
  return uint32_t((threads + kLanes - 1) / kLanes);
}

void Executor::start(WarpContext& warp, uint32_t warp_index) const {
  const Image& image = *world_.image;
  const size_t registers = size_t(image.num_registers) * kLanes;
  if (!warp.regs.bank[0]) {
    warp.own_registers = std::make_unique<uint32_t[]>(registers);
    warp.regs.bank[0] = warp.own_registers.get();
  }
  std::fill_n(warp.regs.bank[0], registers, 0u);
  if (!warp.own_specials) warp.own_specials = std::make_unique<uint32_t[]>(size_t(isa::kNumSpecials) * kLanes);
  warp.regs.bank[1] = image.constants.get();
  warp.regs.bank[2] = warp.own_specials.get();
  std::fill_n(warp.regs.bank[2], size_t(isa::kNumSpecials) * kLanes, 0u);
  warp.regs.predicate.fill(0);
  warp.local.assign(size_t(world_.local_bytes / 4) * kLanes, 0u);
  warp.warp_index = warp_index;
  warp.depth = 0;
  warp.instructions = 0;
  warp.waiting_for_rays = false;

  const uint64_t threads = uint64_t(world_.launch_size[0]) * world_.launch_size[1] * world_.launch_size[2];
  const uint64_t first = uint64_t(warp_index) * kLanes;
  const uint64_t count = std::min<uint64_t>(kLanes, threads - first);
  warp.simt.start(image.shaders[world_.raygen].entry, count == kLanes ? kAllLanes : (LaneMask{1} << count) - 1);
  auto row = [&](isa::Special s) { return warp.regs.bank[2] + size_t(s) * kLanes; };
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto id = launch_id(world_, warp_index, lane);
    row(isa::Special::LaneId)[lane] = uint32_t(lane);
    for (int axis = 0; axis < 3; ++axis) {
      row(isa::Special(int(isa::Special::LaunchX) + axis))[lane] = id[size_t(axis)];
      row(isa::Special(int(isa::Special::LaunchSizeX) + axis))[lane] = world_.launch_size[size_t(axis)];
    }
  }
}

Issued Executor::execute(WarpContext& warp, Cycle now) {
  const uint32_t pc = warp.simt.pc;
  const isa::Inst& inst = world_.image->code[pc];
  const isa::OpRow& row = *world_.image->rows[pc];
  LaneMask exec = warp.simt.active;
  Issued issued{pc, &inst, &row, exec, exec, false};
  if (inst.guard != isa::kNoGuard) {
    const LaneMask guard = warp.regs.predicate[inst.guard & (isa::kNumPredicates - 1)];
    exec &= inst.guard & isa::kGuardNegate ? ~guard : guard;
  }
  warp.regs.exec = issued.lanes = exec;
  if (reads_clock_) [[unlikely]]
    std::fill_n(warp.regs.bank[2] + size_t(isa::Special::Clock) * kLanes, kLanes, uint32_t(now));

  bool ok = true;
  switch (row.effect) {
    case Effect::None:
      row.run(warp.regs, inst);
      ++warp.simt.pc;
      break;
    case Effect::Load:
    case Effect::Store:
    case Effect::Atomic: ok = run_memory(warp, inst, row); break;
    case Effect::Texture:
    case Effect::SurfaceLoad:
    case Effect::SurfaceStore: ok = run_image(warp, inst, row); break;
    case Effect::Branch:
    case Effect::PushReconvergence:
    case Effect::Join:
    case Effect::Exit:
    case Effect::Return:
    case Effect::BranchIndexed:
    case Effect::Call:
    case Effect::Barrier:
    case Effect::Fence:
    case Effect::Ignore:
    case Effect::Terminate: ok = run_control(warp, inst, row); break;
    case Effect::Query:
    case Effect::QueryProceed: ok = run_query(warp, inst, row); break;
    case Effect::CallCandidate:
    case Effect::CallAnyHit:
    case Effect::CallHit:
    case Effect::Trace:
    case Effect::Resume:
    case Effect::Report:
    case Effect::Accepted:
    case Effect::EndTrace:
      ok = run_rays(warp, inst, row);
      issued.lanes = warp.regs.exec;
      break;
  }
  issued.finished = warp.simt.finished();
  if (ok) {
    ++warp.instructions;
    retired.fire([&] { return Retired{warp, issued}; });
  }
  return issued;
}

bool Executor::run_control(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  SimtStack& simt = warp.simt;
  const LaneMask exec = warp.regs.exec;
  const uint32_t target = uint32_t(inst.imm);
  switch (row.effect) {
    case Effect::Branch: {
      const LaneMask stay = simt.active & ~exec;
      if (stay == 0) {
        simt.pc = target;
      } else if (exec == 0) {
        ++simt.pc;
      } else if (world_.image->target_is_join[simt.pc]) {
        // Lanes that go to a join wait there at once: a loop's exits never grow the stack.
        if (!simt.arrive(target, exec)) return fail(warp, std::countr_zero(exec), "branches to a join without its ssy");
        simt.active = stay;
        ++simt.pc;
      } else if (world_.image->rows[simt.pc + 1]->effect == Effect::Join) {
        if (!simt.arrive(simt.pc + 1, stay)) return fail(warp, std::countr_zero(stay), "falls into a join without its ssy");
        simt.active = exec;
        simt.pc = target;
      } else {
        simt.push_path(target, exec);
        simt.active = stay;
        ++simt.pc;
      }
      return true;
    }
    case Effect::PushReconvergence:
      simt.push_reconvergence(target);
      ++simt.pc;
      return true;
    case Effect::Join:
      if (!simt.arrive(simt.pc, simt.active))
        return fail(warp, std::countr_zero(simt.active), "reaches a join without its ssy");
      simt.active = 0;
      resume_if_empty(warp);
      return true;
    case Effect::Exit:
      leave(warp, exec);
      return true;
    case Effect::Return:
    case Effect::Ignore:
    case Effect::Terminate:
      if (exec) finish_shader(warp, row.effect);
      if (!simt.arrive_return(exec)) return fail(warp, std::countr_zero(exec), "returns from a shader that was not called");
      leave(warp, exec);
      return true;
    default: GLINT_PANIC("{} is not a control effect", row.name);
  }
}

void Executor::leave(WarpContext& warp, LaneMask lanes) {
  warp.simt.active &= ~lanes;
  ++warp.simt.pc;
  resume_if_empty(warp);
}

void Executor::resume_if_empty(WarpContext& warp) {
  SimtStack::Entry call{};
  if (warp.simt.active != 0 || !warp.simt.resume_next(&call)) return;
  warp.depth = call.depth;
  if (warp.simt.active == 0) return;
  fill_specials(warp, warp.simt.active, world_.image->shaders[call.shader]);
}

bool Executor::fail(WarpContext& warp, int lane, std::string what) {
  fault_ = Fault{std::move(what), world_.image->place_of(warp.simt.pc), launch_id(world_, warp.warp_index, lane)};
  return false;
}

}  // namespace glint::core
