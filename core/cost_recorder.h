// Records what each thread of a launch cost: time, instructions, idle slots, rays and misses. It runs only
// when asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/core_observer.h"

namespace glint::core {

// Holds the costs of one thread (launch index). Sums over all threads are statistics of the run where one is
// named.
struct ThreadCost {
  uint32_t cycles = 0;  // from the thread's first instruction to its last
  // These are the cycles from an instruction that the thread executed to the next one of its warp.
  uint32_t active_cycles = 0;
  uint32_t instructions = 0;        // executed instructions: core.lane_instructions
  uint32_t rays = 0;                // rt_unit.rays
  uint32_t nodes = 0;               // rt_unit.nodes
  uint32_t triangle_tests = 0;      // rt_unit.triangle_tests
  uint32_t any_hit_calls = 0;       // core.any_hit.invocations
  uint32_t intersection_calls = 0;  // core.intersection.invocations
  // These are lane slots, 32 for each instruction, which are shared among the lanes that execute it:
  // core.lane_slots.
  double slots = 0;
  // This is the thread's part of l1.misses, without those of instructions and constants. Each miss is shared
  // among the lanes that it is for.
  double l1_misses = 0;
};

// Holds the costs of all threads of a launch, z slowest. Cores write only to the threads that they run, so
// several cores may write at a time.
class LaunchCosts {
 public:
  // Throws UserError when the launch has more threads than kMaxThreads.
  explicit LaunchCosts(const exec::World& world);
  static constexpr uint64_t kMaxThreads = 1 << 25;

  const exec::World& world() const { return world_; }
  uint32_t width() const { return world_.launch_size[0]; }
  uint32_t height() const { return world_.launch_size[1]; }
  ThreadCost& at(const std::array<uint32_t, 3>& id) {
    return threads_[(size_t{id[2]} * height() + id[1]) * width() + id[0]];
  }
  const std::vector<ThreadCost>& threads() const { return threads_; }

 private:
  const exec::World& world_;
  std::vector<ThreadCost> threads_;
};

// Hears what the warps of one core do. On the functional machine all cycles are 0.
class CostRecorder final : public CoreObserver {
 public:
  CostRecorder(LaunchCosts& costs, uint32_t slots) : costs_(costs), slots_(slots) {}

  void start_warp(Cycle now, uint32_t slot, const exec::WarpContext& warp) override;
  void issue(Cycle now, uint32_t slot, const exec::Issued& issued) override;
  void call(uint32_t slot, isa::Stage stage, LaneMask lanes) override;
  void start_rays(uint32_t slot, LaneMask lanes, const rt::RayState* states) override;
  void end_rays(uint32_t slot, LaneMask lanes, const rt::RayState* states) override;
  void swap_threads(Cycle now, uint32_t slot_a, int lane_a, uint32_t slot_b, int lane_b) override;
  void end_warp(Cycle now, uint32_t slot) override;
  // Charges a read of the L1 that missed to `lanes`. `of` lanes in all wait for it, these among them.
  void miss(uint32_t slot, LaneMask lanes, int of);

 private:
  struct Slot {
    // These say who is in each lane: the warp and the lane in which the thread began.
    std::array<uint32_t, kLanes> warp_index{};
    std::array<uint8_t, kLanes> first_lane{};
    // These are the lanes that came to an instruction, those that have executed one, and those that executed
    // the last one.
    LaneMask present = 0, started = 0, last = 0;
    Cycle last_issue = 0;
    std::array<Cycle, kLanes> first{}, end{};
    std::array<uint32_t, kLanes> nodes{}, triangle_tests{};  // counts at the start of the rays under way
    std::array<ThreadCost, kLanes> lane;
  };
  static void charge_until(Cycle now, Slot& warp);

  LaunchCosts& costs_;
  std::vector<Slot> slots_;
};

}  // namespace glint::core
