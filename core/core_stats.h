// Counts what a core does: instructions by class and stage, issue slots by reason, accesses, divergence.
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

using isa::kNumStages;

// Counts the instructions of one shader stage, by class. Each instruction belongs to the stage whose code it
// is in: a call counts for its caller, and what the callee executes counts for the callee.
struct StageStats : stats::Group {
  StageStats(Group* parent, const char* name) : Group(parent, name) {}
  stats::Breakdown<isa::Class> instructions{this, "instructions", "instruction",
                                            "Number of warp instructions issued, by class."};
  stats::Breakdown<isa::Class> lanes{this, "lanes", "instruction", "Number of lane instructions, by class."};
  stats::Breakdown<isa::Class> latency{
      this, "latency", "cycle", "Cycles from issue to completion, summed over warp instructions, by class."};
  stats::Counter invocations{this, "invocations", "lane",
                             "Number of lanes that began a shader of the stage."};
};

struct CoreStats : stats::Group {
  CoreStats(Group* parent, std::string name) : Group(parent, std::move(name)) {}

  stats::Counter cycles{this, "cycles", "cycle", "Cycles from the launch to the end of the run."};
  stats::Counter blocks{this, "blocks", "block", "Number of blocks launched on this core."};
  stats::Counter warps{this, "warps", "warp", "Number of warps launched on this core."};
  stats::Counter instructions{this, "instructions", "instruction", "Number of warp instructions issued."};
  stats::Counter sequence_slots{this, "sequence_slots", "instruction",
                                "Number of additional machine instructions, where one ISA instruction stands "
                                "for several, and of those before a kernel's own."};
  stats::Counter lane_instructions{this, "lane_instructions", "instruction",
                                   "Number of lanes that executed, summed over warp instructions."};
  stats::Counter lane_slots{this, "lane_slots", "lane",
                            "Number of lane slots, which is 32 for each warp instruction."};
  stats::Ratio ipc{this,         "ipc",  "instruction/cycle",
                   instructions, cycles, "Warp instructions issued per cycle."};
  stats::Ratio simt_efficiency{this,       "simt_efficiency",
                               "fraction", lane_instructions,
                               lane_slots, "Mean fraction of a warp's lanes that execute an instruction."};
  stats::Counter resident_cycles{this, "resident_cycles", "warp-cycle",
                                 "Number of resident warps, summed over cycles."};
  stats::Counter slot_cycles{this, "slot_cycles", "warp-cycle",
                             "Number of warp slots of the hardware, summed over cycles."};
  stats::Ratio occupancy{
      this, "occupancy", "fraction", resident_cycles, slot_cycles, "Mean fraction of warp slots in use."};
  stats::Breakdown<Stall> stalls{this, "issue_slots", "cycle",
                                 "Cycles of all schedulers, by what each was spent on."};

  stats::Breakdown<isa::Class> by_class{this, "instructions_by_class", "instruction",
                                        "Number of warp instructions issued, by class."};
  stats::Breakdown<isa::Class> lanes_by_class{this, "lanes_by_class", "instruction",
                                              "Number of lane instructions, by class."};
  stats::Breakdown<isa::Class> latency{
      this, "latency_by_class", "cycle",
      "Cycles from issue to completion, summed over warp instructions, by class."};

  stats::Counter global_loads{this, "global_loads", "instruction",
                              "Number of warp instructions that load from global memory."};
  stats::Counter global_stores{this, "global_stores", "instruction",
                               "Number of warp instructions that store to global memory."};
  stats::Counter local_loads{this, "local_loads", "instruction",
                             "Number of warp instructions that load from local memory."};
  stats::Counter local_stores{this, "local_stores", "instruction",
                              "Number of warp instructions that store to local memory."};
  stats::Counter shared_loads{this, "shared_loads", "instruction",
                              "Number of warp instructions that load from shared memory."};
  stats::Counter shared_stores{this, "shared_stores", "instruction",
                               "Number of warp instructions that store to shared memory."};
  stats::Counter shared_atomics{this, "shared_atomics", "instruction",
                                "Number of atomic warp instructions on shared memory."};
  stats::Counter shared_passes{
      this, "shared_passes", "pass",
      "Number of passes of shared memory for loads, stores and atomics. Each takes "
      "1 pass without bank conflicts, and up to 2 or 4 where a lane has 8 or 16 bytes."};
  stats::Counter global_atomics{this, "global_atomics", "instruction",
                                "Number of atomic warp instructions on global memory."};
  stats::Counter barriers{this, "barriers", "instruction",
                          "Number of times that a warp came to a barrier of its block."};
  stats::Counter fences{this, "fences", "instruction", "Number of memory fences."};
  stats::Counter constant_loads{this, "constant_loads", "instruction",
                                "Number of warp instructions that load from the constant bank."};
  stats::Counter texture_fetches{this, "texture_fetches", "instruction",
                                 "Number of warp instructions that fetch filtered textures."};
  stats::Counter surface_loads{this, "surface_loads", "instruction",
                               "Number of warp instructions that load from images."};
  stats::Counter surface_stores{this, "surface_stores", "instruction",
                                "Number of warp instructions that store to images."};
  stats::Counter binding_reads{this, "binding_reads", "instruction",
                               "Number of calls that read the shader binding table."};
  stats::Counter accesses{this, "accesses", "instruction",
                          "Number of warp instructions that accessed the L1."};
  stats::Counter lines{this, "lines", "request",
                       "Number of line requests that warp instructions made to the L1."};
  stats::Counter sectors{this, "sectors", "sector",
                         "Number of 32 B sectors that warp instructions touched in the L1."};
  stats::Ratio lines_per_access{
      this,  "lines_per_access", "request/instruction",
      lines, accesses,           "Mean number of lines of a warp instruction that accesses the L1."};
  stats::Ratio sectors_per_access{this,
                                  "sectors_per_access",
                                  "sector/instruction",
                                  sectors,
                                  accesses,
                                  "Mean number of sectors of a warp instruction that accesses the L1."};

  stats::Counter branches{this, "branches", "instruction", "Number of conditional branches."};
  stats::Counter divergent_branches{this, "divergent_branches", "instruction",
                                    "Number of conditional branches that split their warp."};
  stats::Counter rt_warps{this, "rt_warps", "warp", "Number of times that a warp was handed to the RT unit."};
  stats::Counter rt_lanes{this, "rt_lanes", "ray",
                          "Number of rays in the warps that were handed to the RT unit."};
  stats::Counter candidate_calls{
      this, "candidate_calls", "call",
      "Number of calls of intersection and any-hit shaders. Each shader that a warp calls counts once."};
  stats::Counter candidate_lanes{this, "candidate_lanes", "lane",
                                 "Number of lanes that called intersection and any-hit shaders."};
  stats::Ratio lanes_per_candidate_call{
      this,
      "lanes_per_candidate_call",
      "lane/call",
      candidate_lanes,
      candidate_calls,
      "Mean number of lanes that run an intersection or any-hit shader together."};
  stats::Counter candidates_gathered{this, "candidates_gathered", "candidate",
                                     "Number of candidates put into tables (deferred any-hit)."};
  stats::Counter candidates_dropped{
      this, "candidates_dropped", "candidate",
      "Number of candidates in tables whose shader never ran, because the ray ended nearer."};
  stats::Counter table_overflows{this, "table_overflows", "ray",
                                 "Number of times that a ray stopped because its table was full."};

  // The order is that of isa::Stage.
  StageStats raygen{this, "raygen"}, intersection{this, "intersection"}, any_hit{this, "any_hit"},
      closest_hit{this, "closest_hit"}, miss{this, "miss"}, callable{this, "callable"},
      compute{this, "compute"};
  std::array<StageStats*, kNumStages> stage{&raygen, &intersection, &any_hit, &closest_hit,
                                            &miss,   &callable,     &compute};
};

}  // namespace glint::core
