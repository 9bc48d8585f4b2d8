// Computes the equations, and finds their inputs in a run.
// SPDX-License-Identifier: Apache-2.0
#include "report/analytical/hong_kim.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "report/metrics/formula.h"

namespace glint::report {
namespace {

constexpr double kSectorBytes = 32;  // bytes of a request to DRAM

constexpr const char* kDramLatency = "sum(l1.miss_cycles) / sum(l1.timed_misses)";

double value_of(const std::string& formula, const RunRecord& run, const std::string& name) {
  if (const std::optional<double> value = evaluate(formula, run)) return *value;
  if (formula == kDramLatency && run.text("mode") == "timing")
    throw UserError(
        {name}, "none of this run's reads missed in the L1, so there is no latency of memory to model",
        "Hong and Kim's model takes timing runs that read memory; all models take runs of scenes");
  throw UserError({name}, fmt::format("this run has no '{}'", formula),
                  "the model needs a finished run of the timing machine: glint run --mode timing");
}

}  // namespace

HongKimInputs hong_kim_inputs(const RunRecord& run, const std::string& name) {
  const auto value = [&](const std::string& formula) { return value_of(formula, run, name); };
  HongKimInputs in;
  in.cores = value("config(cores)");
  const double warps = value("sum(core.warps)");
  in.warps = std::min(value("run(residency.warps)"), warps / in.cores);
  in.repetitions = warps / in.cores / in.warps;
  in.instructions = value("sum(core.instructions)") / warps;
  const double memory =
      value("sum(core.instructions_by_class::mem) + sum(core.instructions_by_class::tex) + sum(rt.warps)");
  in.memory_instructions = memory / warps;
  in.accesses = value("sum(l1.reads::*) + sum(l1.writes::*)") / memory;
  in.dram_latency = value(kDramLatency);
  in.miss_rate = value("sum(l1.misses::*) / sum(l1.reads::*)");
  in.departure_delay = 1 / value("config(memory.l1.ports)");
  in.issue_cycles = 1 / value("config(core.schedulers)");
  in.bytes = kSectorBytes * value("sum(dram.requests)") / memory;
  in.bandwidth = value("run(memory_peaks.dram_bytes_per_second) / (config(clock_mhz) * 1000000)");
  return in;
}

HongKimResult hong_kim(const HongKimInputs& in) {
  HongKimResult out;
  out.inputs = in;
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
  } else if (out.cwp >= out.mwp || out.computation_cycles > out.memory_cycles) {
    out.equation = 23;
    out.cycles = out.memory_cycles * in.warps / out.mwp + between * (out.mwp - 1);
  } else {
    out.equation = 24;
    out.cycles = latency + out.computation_cycles * in.warps;
  }
  out.cycles *= in.repetitions;
  return out;
}

std::vector<std::pair<std::string, double>> hong_kim_columns(const HongKimResult& result) {
  const HongKimInputs& in = result.inputs;
  return {{"warps_per_core", in.warps},
          {"repetitions", in.repetitions},
          {"instructions_per_warp", in.instructions},
          {"memory_instructions_per_warp", in.memory_instructions},
          {"accesses_per_memory_instruction", in.accesses},
          {"dram_latency", in.dram_latency},
          {"l1_miss_rate", in.miss_rate},
          {"memory_latency", in.memory_latency()},
          {"departure_delay", in.departure_delay},
          {"issue_cycles", in.issue_cycles},
          {"dram_bytes_per_memory_instruction", in.bytes},
          {"dram_bytes_per_cycle", in.bandwidth},
          {"memory_cycles", result.memory_cycles},
          {"computation_cycles", result.computation_cycles},
          {"mwp_without_bandwidth", result.mwp_without_bandwidth},
          {"mwp_peak_bandwidth", result.mwp_peak_bandwidth},
          {"mwp", result.mwp},
          {"cwp", result.cwp},
          {"equation", double(result.equation)}};
}

}  // namespace glint::report
