// The whole GPU's parameters: what a preset in configs/ sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <tuple>

#include "base/diagnostics.h"
#include "base/params.h"
#include "core/params.h"
#include "memsys/params.h"
#include "rtunit/build.h"
#include "rtunit/params.h"

namespace glint::pipeline {

// What the compiler may use of the machine it compiles for.
struct CompilerParams {
  uint32_t max_registers = 64;
  bool schedule = true;
  bool contract = false;
  uint32_t guard_latency = 0;
  bool queries_call = false;  // no key: what GpuParams::rt.unit asks of code with ray queries
  static constexpr auto params() {
    return std::tuple{
        param(&CompilerParams::max_registers, "max_registers", "register",
              "32-bit registers a thread; more spill to local memory.", 8, 255),
        flag(&CompilerParams::schedule, "schedule", "Reorders instructions within a block to hide latency."),
        flag(&CompilerParams::contract, "contract",
             "GLSL's a * b + c becomes one fma, as drivers do, but where it is `precise`."),
        param(&CompilerParams::guard_latency, "guard_latency", "cycle",
              "Later that a predicate guards than it can be read, as the order of instructions expects.", 0,
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
  static constexpr auto params() {
    return std::tuple{
        param(&GpuParams::cores, "cores", "core",
              "Cores (streaming multiprocessors), each with its L1 and RT unit.", 1, 256),
        param(&GpuParams::clock_mhz, "clock_mhz", "MHz", "Clock of cores, network and L2.", 1.0, 10000.0),
        section(&GpuParams::core, "core", "Each core."),
        section(&GpuParams::memory, "memory", "Caches, network and DRAM."),
        section(&GpuParams::rt, "rt", "Each core's ray-tracing unit."),
        section(&GpuParams::bvh, "bvh", "How acceleration structures are built."),
        section(&GpuParams::compiler, "compiler", "Code generation.")};
  }
};

}  // namespace glint::pipeline
