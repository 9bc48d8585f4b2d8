// Puts a core between mocks and writes programs in place, for tests of when things happen.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/core_cell.h"
#include "core/dispatcher.h"
#include "engine/engine.h"
#include "engine/engine_loop.h"
#include "rtunit/structure/structure.h"
#include "tests/support/fixed_latency_memory.h"

namespace glint::core {

// Answers every warp after the same number of cycles, with all rays done and nothing hit.
class FixedLatencyRays final : public rt::RtPort {
 public:
  FixedLatencyRays(Cycle latency, size_t capacity) : latency_(latency), capacity_(capacity) { tell(); }
  void submit(Cycle now, uint32_t warp_slot, LaneMask mask, rt::RayState* states) override {
    for_each_lane(mask, [&](int lane) { states[lane].status = rt::RayStatus::Done; });
    inside_.push_back({now + latency_, warp_slot});
    lanes_.push_back(mask);
    tell();
  }
  std::optional<uint32_t> pop_completion(Cycle now) override {
    if (inside_.empty() || inside_.front().at > now) return std::nullopt;
    const uint32_t slot = inside_.front().slot;
    inside_.pop_front();
    tell();
    return slot;
  }
  void tick(Cycle) override {}
  Cycle next_event(Cycle now) const override {
    return inside_.empty() ? kNever : inside_.front().at < now + 1 ? now + 1 : inside_.front().at;
  }
  const std::vector<LaneMask>& lanes() const { return lanes_; }  // lanes of each submit

 private:
  struct Inside {
    Cycle at;
    uint32_t slot;
  };
  void tell() {
    set_room(inside_.size() < capacity_);
    set_completion(!inside_.empty());
  }

  const Cycle latency_;
  const size_t capacity_;
  std::deque<Inside> inside_;
  std::vector<LaneMask> lanes_;
};

inline isa::Slot reg(int n) {
  return isa::Slot(n);
}
inline isa::Slot special(isa::Special s) {
  return isa::Slot(isa::kSpecialBank + int(s));
}

// Writes a compute shader, instruction by instruction.
class Code {
 public:
  Code() { program_.name = "test"; }
  isa::Slot constant(uint32_t value) {
    program_.constants.push_back(value);
    return isa::Slot(isa::kConstantBank + program_.constants.size() - 1);
  }
  isa::Slot constant64(uint64_t value) {
    const isa::Slot low = constant(uint32_t(value));
    constant(uint32_t(value >> 32));
    return low;
  }
  // Adds an instruction and returns its index.
  int add(std::string_view op, std::initializer_list<isa::Slot> operands = {}, int imm = 0,
          uint8_t guard = isa::kNoGuard) {
    isa::Inst inst;
    inst.op = isa::op_index(op);
    inst.guard = guard;
    inst.imm = imm;
    size_t i = 0;
    for (isa::Slot slot : operands) {
      inst.operand[i++] = slot;
      if (slot < isa::kMaxRegisters && slot + 2u > program_.num_registers) program_.num_registers = slot + 2u;
    }
    program_.code.push_back(inst);
    return int(program_.code.size()) - 1;
  }
  void set_target(int at, int target) { program_.code[size_t(at)].imm = target; }
  int here() const { return int(program_.code.size()); }
  isa::Program& program() { return program_; }

 private:
  isa::Program program_;
};

// Returns parameters without launch latency and without anything that costs cycles beside what a test adds
// up. Tests of other costs turn them on.
inline Params quick_params() {
  Params params;
  params.launch_latency = 0;
  params.block_interval = 0;
  params.write_order = true;
  params.fetch.perfect = params.constant.perfect = true;
  params.constant.serial = false;
  params.lsu.war_latency = params.lsu.shared_war_latency = 0;
  params.texture = {0, 0, false};
  return params;
}

// Holds one core with `num_warps` warps of one program. Memory answers after 20 cycles, and the RT unit after
// 100.
struct OneCore {
  static constexpr Cycle kMemoryLatency = 20, kRayLatency = 100;
  struct Options {
    uint32_t num_warps = 1;
    bool no_skip = false;
    uint32_t local_bytes = 0;
    uint32_t accesses_per_cycle = ~0u;
    size_t rt_capacity = 4;
    Cycle window = 32;
    uint32_t block_threads = 0;  // 0: no blocks
    uint32_t shared_bytes = 0;
    Address code = 0, constants = 0;
  };

  OneCore(Code& code, const Params& params, Options options)
      : params_(params),
        options_(options),
        l1(kMemoryLatency, options.accesses_per_cycle),
        rays(kRayLatency, options.rt_capacity) {
    std::vector<isa::Program> programs;
    programs.push_back(code.program());
    image = exec::link(programs);
    world.image = &image;
    world.memory = &memory;
    world.raygen = 0;
    world.constant_bank.resize(isa::kConstantBankBytes);
    world.launch_size = {options.num_warps * uint32_t(kLanes), 1, 1};
    world.local_bytes = options.local_bytes;
    if (options.block_threads)
      exec::set_blocks(world, {options.num_warps * uint32_t(kLanes) / options.block_threads, 1, 1},
                       {options.block_threads, 1, 1}, options.shared_bytes);
  }
  // Runs to the end and returns the cycle after the core's last activity.
  Cycle run() {
    cell = std::make_unique<CoreCell>(params_, CoreCell::Context{world,
                                                                 l1,
                                                                 rays,
                                                                 kLocalBase,
                                                                 &root,
                                                                 "core",
                                                                 options_.no_skip,
                                                                 0,
                                                                 1,
                                                                 0.0,
                                                                 0,
                                                                 {options_.code, options_.constants}});
    if (profile) cell->start_profile();
    EngineLoop engine({options_.window, options_.no_skip, 100'000});
    engine.add(*cell);
    Dispatcher dispatcher(params_, exec::Executor(world).num_blocks(), {cell.get()}, world.in_clusters);
    engine.run([&](Cycle now) {
      if (cell->fault()) return EngineLoop::Next::Stop;
      dispatcher.dispatch(now);
      return dispatcher.done() ? EngineLoop::Next::NothingMore : EngineLoop::Next::Continue;
    });
    cell->finish(cell->active_until());
    return cell->active_until();
  }
  const CoreStats& stats() const { return cell->stats(); }

  static constexpr Address kLocalBase = 1 << 20;
  Params params_;
  Options options_;
  bool profile = false;
  mem::AddressSpace memory;
  exec::World world;
  exec::Image image;
  mem::FixedLatencyMemory l1;
  FixedLatencyRays rays;
  stats::Group root{nullptr, "test"};
  std::unique_ptr<CoreCell> cell;
};

}  // namespace glint::core
