// Declares the parameters of the whole GPU, which a preset in configs/ sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/params.h"
#include "core/params.h"
#include "memsys/params.h"
#include "rtunit/params.h"
#include "rtunit/structure/build.h"

namespace glint::pipeline {

// Says what the compiler may use of the machine it compiles for.
struct CompilerParams {
  uint32_t max_registers = 64;
  bool schedule = true;
  bool contract = false;
  uint32_t guard_latency = 0;
  // These have no keys. The first follows from GpuParams::rt.unit, and the others from core.reorder.
  bool queries_call = false, reorder_calls = false, reorder_traces = false;
  static ParamList params() {
    return {
        param(&CompilerParams::max_registers, "max_registers", "register",
              "Number of 32-bit registers per thread. Values beyond them spill to local memory.", 8, 255),
        flag(&CompilerParams::schedule, "schedule",
             "True: the compiler reorders instructions within a block to hide latency."),
        flag(&CompilerParams::contract, "contract",
             "True: a * b + c of GLSL becomes one fma, as in drivers, except where it is `precise`."),
        param(&CompilerParams::guard_latency, "guard_latency", "cycle",
              "Extra cycles the compiler's scheduler assumes before a predicate can guard an instruction.", 0,
              100)};
  }
};

struct GpuParams {
  uint32_t cores = 8;
  double clock_mhz = 1365;
  core::Params core;
  mem::Params memory;
  rt::Params rt;
  rt::BuildOptions bvh;
  CompilerParams compiler;
  static ParamList params() {
    return {param(&GpuParams::cores, "cores", "core",
                  "Number of cores (streaming multiprocessors). Each has an L1 and an RT unit.", 1, 256),
            param(&GpuParams::clock_mhz, "clock_mhz", "MHz", "Clock frequency of cores, network and L2.", 1.0,
                  10000.0),
            section(&GpuParams::core, "core", "Parameters of each core."),
            section(&GpuParams::memory, "memory", "Parameters of caches, network and DRAM."),
            section(&GpuParams::rt, "rt", "Parameters of each core's ray-tracing unit."),
            section(&GpuParams::bvh, "bvh", "Parameters of the construction of acceleration structures."),
            section(&GpuParams::compiler, "compiler", "Parameters of code generation.")};
  }
};

}  // namespace glint::pipeline
