// What a core counts: instructions by class and stage, issue slots by reason, memory accesses, divergence.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "base/stats.h"
#include "core/stall.h"
#include "isa/op_row.h"
#include "isa/program.h"

namespace glint::core {

inline constexpr int kNumStages = int(isa::Stage::Compute) + 1;

// Instructions of one shader stage, by class. Each is of the stage whose code it stands in: a call counts at
// its caller, what the callee executes at the callee.
struct StageStats : stats::Group {
  StageStats(Group* parent, const char* name) : Group(parent, name) {}
  stats::Breakdown<isa::Class> instructions{this, "instructions", "instruction",
                                            "Warp instructions issued, by class."};
  stats::Breakdown<isa::Class> lanes{this, "lanes", "instruction", "Lane instructions, by class."};
  stats::Breakdown<isa::Class> latency{this, "latency", "cycle", "Issue to completion, summed, by class."};
  stats::Counter invocations{this, "invocations", "lane", "Lanes that began a shader of the stage."};
};

struct CoreStats : stats::Group {
  CoreStats(Group* parent, std::string name) : Group(parent, std::move(name)) {}

  stats::Counter cycles{this, "cycles", "cycle", "Cycles from the launch to the end of the run."};
  stats::Counter blocks{this, "blocks", "block", "Blocks launched on this core."};
  stats::Counter warps{this, "warps", "warp", "Warps launched on this core."};
  stats::Counter instructions{this, "instructions", "instruction", "Warp instructions issued."};
  stats::Counter sequence_slots{this, "sequence_slots", "instruction",
                                "Further instructions of the part where one of the ISA stands for several, "
                                "and those before a kernel's own."};
  stats::Counter lane_instructions{this, "lane_instructions", "instruction",
                                   "Lanes that executed them, summed."};
  stats::Counter lane_slots{this, "lane_slots", "lane", "32 for each warp instruction."};
  stats::Ratio ipc{this,         "ipc",  "instruction/cycle",
                   instructions, cycles, "Warp instructions issued a cycle."};
  stats::Ratio simt_efficiency{this,       "simt_efficiency",
                               "fraction", lane_instructions,
                               lane_slots, "Mean fraction of a warp's lanes that execute."};
  stats::Counter resident_cycles{this, "resident_cycles", "warp-cycle",
                                 "Resident warps, summed over cycles."};
  stats::Counter slot_cycles{this, "slot_cycles", "warp-cycle",
                             "Warp slots of the hardware, summed over cycles."};
  stats::Ratio occupancy{
      this, "occupancy", "fraction", resident_cycles, slot_cycles, "Mean fraction of warp slots in use."};
  stats::Breakdown<Stall> stalls{this, "issue_slots", "cycle",
                                 "Every cycle of every scheduler, by what it was spent on."};

  stats::Breakdown<isa::Class> by_class{this, "instructions_by_class", "instruction",
                                        "Warp instructions issued, by class."};
  stats::Breakdown<isa::Class> lanes_by_class{this, "lanes_by_class", "instruction",
                                              "Lane instructions, by class."};
  stats::Breakdown<isa::Class> latency{this, "latency_by_class", "cycle",
                                       "Issue to completion, summed, by class."};

  stats::Counter global_loads{this, "global_loads", "instruction", "Loads from global memory."};
  stats::Counter global_stores{this, "global_stores", "instruction", "Stores to global memory."};
  stats::Counter local_loads{this, "local_loads", "instruction", "Loads from local memory."};
  stats::Counter local_stores{this, "local_stores", "instruction", "Stores to local memory."};
  stats::Counter shared_loads{this, "shared_loads", "instruction", "Loads from shared memory."};
  stats::Counter shared_stores{this, "shared_stores", "instruction", "Stores to shared memory."};
  stats::Counter shared_atomics{this, "shared_atomics", "instruction", "Atomics on shared memory."};
  stats::Counter shared_passes{this, "shared_passes", "pass",
                               "Passes of shared memory for them: 1 each without bank conflicts."};
  stats::Counter global_atomics{this, "global_atomics", "instruction", "Atomics on global memory."};
  stats::Counter barriers{this, "barriers", "instruction", "Times a warp came to a barrier of its block."};
  stats::Counter fences{this, "fences", "instruction", "Memory fences."};
  stats::Counter constant_loads{this, "constant_loads", "instruction", "Loads from the constant bank."};
  stats::Counter texture_fetches{this, "texture_fetches", "instruction", "Filtered texture fetches."};
  stats::Counter surface_loads{this, "surface_loads", "instruction", "Loads from images."};
  stats::Counter surface_stores{this, "surface_stores", "instruction", "Stores to images."};
  stats::Counter binding_reads{this, "binding_reads", "instruction",
                               "Calls that read the shader binding table."};
  stats::Counter accesses{this, "accesses", "instruction", "Warp instructions that went to the L1."};
  stats::Counter lines{this, "lines", "request", "Line requests they made."};
  stats::Counter sectors{this, "sectors", "sector", "32 B sectors they touched."};
  stats::Ratio lines_per_access{this,  "lines_per_access", "request/instruction",
                                lines, accesses,           "Mean lines of a warp access."};
  stats::Ratio sectors_per_access{
      this, "sectors_per_access", "sector/instruction", sectors, accesses, "Mean sectors of a warp access."};

  stats::Counter branches{this, "branches", "instruction", "Conditional branches."};
  stats::Counter divergent_branches{this, "divergent_branches", "instruction",
                                    "Conditional branches that split their warp."};
  stats::Counter rt_warps{this, "rt_warps", "warp", "Times a warp was handed to the RT unit."};
  stats::Counter rt_lanes{this, "rt_lanes", "ray", "Rays in those warps."};
  stats::Counter candidate_calls{this, "candidate_calls", "call",
                                 "Calls of intersection and any-hit shaders, one a warp and shader."};
  stats::Counter candidate_lanes{this, "candidate_lanes", "lane", "Lanes that made them."};
  stats::Ratio lanes_per_candidate_call{this,
                                        "lanes_per_candidate_call",
                                        "lane/call",
                                        candidate_lanes,
                                        candidate_calls,
                                        "Mean lanes that run such a shader together."};
  stats::Counter candidates_gathered{this, "candidates_gathered", "candidate",
                                     "Candidates put into tables (deferred any-hit)."};
  stats::Counter candidates_dropped{this, "candidates_dropped", "candidate",
                                    "Of them, those whose shader never ran: the ray ended nearer."};
  stats::Counter table_overflows{this, "table_overflows", "ray",
                                 "Times a ray stopped because its table was full."};

  // In the order of isa::Stage.
  StageStats raygen{this, "raygen"}, intersection{this, "intersection"}, any_hit{this, "any_hit"},
      closest_hit{this, "closest_hit"}, miss{this, "miss"}, callable{this, "callable"},
      compute{this, "compute"};
  std::array<StageStats*, kNumStages> stage{&raygen, &intersection, &any_hit, &closest_hit,
                                            &miss,   &callable,     &compute};

  // An instruction of the stage and class took so long from issue to completion.
  void add_latency(isa::Stage in, isa::Class klass, uint64_t duration) {
    latency.add(klass, duration);
    stage[size_t(in)]->latency.add(klass, duration);
  }
};

}  // namespace glint::core
