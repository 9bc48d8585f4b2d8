// Computes Hong and Kim's model of a GPU (ISCA 2009) with an adjustment for caches, after LumiBench's (its
// section 5.5).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/files/run_record.h"

namespace glint::report {

// Holds what the model is given. All of it comes from statistics and configuration of a finished run of the
// timing machine.
struct HongKimInputs {
  double launches = 1;      // launches one after another, which are taken to be alike
  double cores = 0;         // cores that got work
  double warps = 0;         // warps that are resident on such a core at a time (the paper's N)
  double blocks = 0;        // blocks that these warps belong to
  double repetitions = 0;   // times that a core is filled with these warps
  double instructions = 0;  // instructions of a warp, those of sequences one by one
  // These are the instructions of a warp that go to global memory: loads, stores and atomics, accesses to
  // local memory, textures and images, and traces. Shared memory and constants are computation, as in the
  // paper. Choice: a trace is a memory instruction of many accesses.
  double memory_instructions = 0;
  // These are the L1 accesses of a memory instruction, 1 if it is coalesced. Every access of a core departs
  // after the same delay here, so the paper's weights of coalesced and uncoalesced instructions are in the
  // mean.
  double accesses = 0;
  // These are the cycles from an L1 miss to its data, those of a hit, and the fraction of L1 reads that miss.
  double dram_latency = 0, hit_latency = 0, miss_rate = 0;
  double departure_delay = 0;  // cycles between two accesses of a core
  double issue_cycles = 0;     // cycles of a core for a warp instruction
  double barriers = 0;         // barriers of a warp
  double launch_latency = 0;   // cycles before the first warp
  // These are the DRAM bytes of a memory instruction. Choice: only misses count; the paper adjusts only the
  // latency.
  double bytes = 0;
  double bandwidth = 0;  // DRAM bytes per cycle

  // Returns the mean latency of an access. Choice: LumiBench leaves out the hits, so that a kernel whose
  // loads all hit would not wait for them.
  double memory_latency() const { return dram_latency * miss_rate + hit_latency * (1 - miss_rate); }
};

struct HongKimResult {
  HongKimInputs inputs;
  double memory_cycles = 0, computation_cycles = 0;                   // cycles of a warp
  double mwp_without_bandwidth = 0, mwp_peak_bandwidth = 0, mwp = 0;  // memory warp parallelism
  double cwp = 0;                                                     // computation warp parallelism
  int equation = 0;                 // the paper's equation that applies: 22, 23 or 24
  double synchronization_cost = 0;  // cycles that barriers add
  double cycles = 0;                // predicted cycles
};

HongKimResult hong_kim(const HongKimInputs& inputs);

// Returns the inputs of a run, whose statistics are sums over its launches. Throws UserError that names what
// is missing when the run has no such statistics, because it was not of the timing machine or did not finish.
HongKimInputs hong_kim_inputs(const RunRecord& run, const std::string& name, double launches = 1);

// Returns the inputs as LumiBench's paper takes them: it multiplies the latency of DRAM by the rate of L1
// misses and changes nothing else. So hits take no time, and a memory instruction moves the bytes that a warp
// loads with 4 bytes a lane, as on the GPU without caches that the model was made for.
HongKimInputs as_lumibench(HongKimInputs inputs);

// Returns names and values of inputs and results, in order, for tables.
std::vector<std::pair<std::string, double>> hong_kim_columns(const HongKimResult& result);

}  // namespace glint::report
