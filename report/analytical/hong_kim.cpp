// Computes the equations, and finds their inputs in a run.
// SPDX-License-Identifier: Apache-2.0
#include "report/analytical/hong_kim.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "base/diagnostics.h"
#include "report/metrics/formula.h"

namespace glint::report {
namespace {

constexpr double kSectorBytes = 32;  // bytes of a request to DRAM

// These instructions go to global memory. Traces are counted by the RT units.
constexpr const char* kMemoryInstructions =
    "sum(core.global_loads) + sum(core.global_stores) + sum(core.global_atomics) + sum(core.local_loads) + "
    "sum(core.local_stores) + sum(core.texture_fetches) + sum(core.surface_loads) + sum(core.surface_stores) "
    "+ "
    "sum(core.binding_reads) + sum(rt.warps)";
// Instruction lines and constants that reach the L1 are not accesses of these.
constexpr const char* kReads = "sum(l1.reads::*) - sum(l1.reads::instruction) - sum(l1.reads::constant)";

double ratio(double above, double below) {
  return below > 0 ? above / below : 0;
}

// Returns the sum of the statistics whose path matches, of which there may be none.
double total(const RunRecord& run, const std::string& pattern) {
  const std::vector<double> values = run.values(pattern);
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double value_of(const std::string& formula, const RunRecord& run, const std::string& name) {
  if (const std::optional<double> value = evaluate(formula, run)) return *value;
  throw UserError({name}, fmt::format("this run has no '{}'", formula),
                  "the model needs a finished run of the timing machine: glint run --mode timing");
}

// Returns the cores that a launch of so many blocks gives work to. A run with totals alone does not have them
// one by one.
double cores_of(const RunRecord& run, double blocks, const std::string& name) {
  double out = 0;
  for (const double each : run.values("gpu.core[*].warps")) out += each > 0;
  if (run.text("statistics") == "compact") out = value_of("config(cores)", run, name);
  return std::clamp(blocks, 1.0, std::max(out, 1.0));
}

}  // namespace

HongKimInputs hong_kim_inputs(const RunRecord& run, const std::string& name, double launches) {
  const auto value = [&](const std::string& formula) { return value_of(formula, run, name); };
  HongKimInputs in;
  const double warps = value("sum(core.warps)"), blocks = value("sum(core.blocks)");
  in.launches = launches;
  in.cores = cores_of(run, blocks / launches, name);
  in.warps = std::min(value("run(residency.warps)"), warps / launches / in.cores);
  in.blocks = in.warps * blocks / warps;
  in.repetitions = warps / launches / in.cores / in.warps;
  in.instructions = value("sum(core.instructions) + sum(core.sequence_slots)") / warps;
  in.barriers = value("sum(core.barriers)") / warps;
  const double memory = value(kMemoryInstructions), reads = value(kReads);
  in.memory_instructions = memory / warps;
  in.accesses = ratio(reads + value("sum(l1.writes::*)"), memory);
  // Atomics are not among the timed misses, so a run that has nothing else takes the latency of all reads.
  const double timed = value("sum(l1.timed_misses)");
  in.dram_latency = timed > 0 ? value("sum(l1.miss_cycles)") / timed
                              : ratio(total(run, "gpu.memory.load_latency.cycles::*"),
                                      total(run, "gpu.memory.load_latency.reads::*"));
  in.hit_latency = value("config(memory.l1.hit_latency)");
  in.miss_rate =
      ratio(value("sum(l1.misses::*) - sum(l1.misses::instruction) - sum(l1.misses::constant)"), reads);
  in.launch_latency = value("config(core.launch_latency)");
  in.departure_delay = 1 / value("config(memory.l1.ports)");
  in.issue_cycles = 1 / value("config(core.schedulers)");
  in.bytes = ratio(kSectorBytes * value("sum(dram.requests)"), memory);
  in.bandwidth = value("run(memory_peaks.dram_bytes_per_second) / (config(clock_mhz) * 1000000)");
  return in;
}

HongKimInputs as_lumibench(HongKimInputs inputs) {
  constexpr double kLoadedBytes = 32 * 4;
  inputs.hit_latency = 0;
  inputs.bytes = kLoadedBytes;
  return inputs;
}

namespace {

// Predicts a launch without memory instructions: warps compute in turns.
HongKimResult computation_alone(HongKimResult out) {
  const HongKimInputs& in = out.inputs;
  out.equation = 24, out.cwp = 1;
  out.computation_cycles = in.issue_cycles * in.instructions;
  out.cycles = in.launches * (in.launch_latency + out.computation_cycles * in.warps * in.repetitions);
  return out;
}

}  // namespace

HongKimResult hong_kim(const HongKimInputs& in) {
  HongKimResult out;
  out.inputs = in;
  if (in.memory_instructions == 0) return computation_alone(out);
  const double latency =
      in.memory_latency() +
      (in.accesses - 1) * in.departure_delay;             // latency of a memory instruction (Mem_L_Uncoal)
  const double delay = in.accesses * in.departure_delay;  // time until the next memory instruction may go
  out.memory_cycles = latency * in.memory_instructions;
  out.computation_cycles = in.issue_cycles * in.instructions;
  out.mwp_without_bandwidth = std::max(1.0, latency / delay);
  // BW_per_warp is bytes / latency, and all cores share the bandwidth.
  out.mwp_peak_bandwidth =
      in.bytes > 0 ? std::max(1.0, in.bandwidth / (in.bytes / latency * in.cores)) : in.warps;
  out.mwp = std::min({out.mwp_without_bandwidth, out.mwp_peak_bandwidth, in.warps});
  out.cwp = std::min((out.memory_cycles + out.computation_cycles) / out.computation_cycles, in.warps);
  // The computation between two memory instructions takes this number of cycles.
  const double between = out.computation_cycles / in.memory_instructions;
  if (out.mwp == in.warps && out.cwp == in.warps) {
    out.equation = 22;
    out.cycles = out.memory_cycles + out.computation_cycles + between * (out.mwp - 1);
  } else if (out.cwp >= out.mwp) {
    // Choice: the paper also takes (23) where a warp computes longer than it waits. It counts the computation
    // of one warp only, so (24) is taken there.
    out.equation = 23;
    out.cycles = out.memory_cycles * in.warps / out.mwp + between * (out.mwp - 1);
  } else {
    out.equation = 24;
    out.cycles = latency + out.computation_cycles * in.warps;
  }
  out.synchronization_cost = delay * (out.mwp - 1) * in.barriers * in.blocks * in.repetitions;
  out.cycles = in.launches * (in.launch_latency + out.cycles * in.repetitions + out.synchronization_cost);
  return out;
}

std::vector<std::pair<std::string, double>> hong_kim_columns(const HongKimResult& result) {
  const HongKimInputs& in = result.inputs;
  return {{"launches", in.launches},
          {"cores", in.cores},
          {"warps_per_core", in.warps},
          {"blocks_per_core", in.blocks},
          {"repetitions", in.repetitions},
          {"instructions_per_warp", in.instructions},
          {"memory_instructions_per_warp", in.memory_instructions},
          {"accesses_per_memory_instruction", in.accesses},
          {"dram_latency", in.dram_latency},
          {"l1_hit_latency", in.hit_latency},
          {"l1_miss_rate", in.miss_rate},
          {"memory_latency", in.memory_latency()},
          {"departure_delay", in.departure_delay},
          {"issue_cycles", in.issue_cycles},
          {"barriers_per_warp", in.barriers},
          {"launch_latency", in.launch_latency},
          {"dram_bytes_per_memory_instruction", in.bytes},
          {"dram_bytes_per_cycle", in.bandwidth},
          {"memory_cycles", result.memory_cycles},
          {"computation_cycles", result.computation_cycles},
          {"mwp_without_bandwidth", result.mwp_without_bandwidth},
          {"mwp_peak_bandwidth", result.mwp_peak_bandwidth},
          {"mwp", result.mwp},
          {"cwp", result.cwp},
          {"equation", double(result.equation)},
          {"synchronization_cost", result.synchronization_cost}};
}

}  // namespace glint::report
