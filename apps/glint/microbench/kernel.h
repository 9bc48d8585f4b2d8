// Runs small PTX kernels on the timing machine and returns differences of cycles between them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/kernel_launch.h"
#include "pipeline/params.h"

namespace glint::app {

// Holds one measured number. `name` and `param` are those of the files that `--compare` reads.
struct MicroResult {
  std::string group, name, param, unit;
  double value = 0;
};

// Describes one benchmark, which gives one row.
struct MicroBench {
  std::string group, name, param, unit;
  std::function<double(const pipeline::GpuParams&)> measure;
};

// Describes a kernel around a body, with the parameters `data` (the address of a buffer) and `n`.
struct MicroKernel {
  // A loop of n turns repeats `body` `unroll` times; %turn counts the turns down. `before` and `after` stand
  // around the loop.
  std::string before, body, after;
  uint32_t unroll = 1;
  uint32_t turns = 1;
  std::vector<uint64_t> data{0};  // words of 8 bytes
  uint64_t bytes = 0;             // size of the buffer, at least; what `data` does not give is 0
  uint32_t blocks = 1, threads = 32;
  std::string variables;  // variables of the module
  bool is_loop = true;    // false: no loop around the bodies
};

// Returns the kernel's whole text. Registers %f, %d, %r, %rd, %h and %p are declared from 0 to 63; %rd0 is
// the buffer and %r0 is n.
std::string text_of(const MicroKernel& kernel);
// Returns the cycles of a launch.
uint64_t cycles_of(const MicroKernel& kernel, const pipeline::GpuParams& gpu);

// Returns the cycles of a body: the difference of two launches, so that launching, loops and the first misses
// cancel.
double cycles_per_body(MicroKernel kernel, uint32_t few, uint32_t many, const pipeline::GpuParams& gpu);
// Returns the cycles of a turn of the loop, which includes the loop's own instructions.
double cycles_per_turn(MicroKernel kernel, uint32_t few, uint32_t many, const pipeline::GpuParams& gpu);

// Returns the machine with one core, for what does not share the memory.
pipeline::GpuParams with_one_core(pipeline::GpuParams gpu);

// Returns the threads of a block that fills a core when its warps do not matter: 32 warps, or all that a core
// has.
uint32_t full_block(const pipeline::GpuParams& gpu);

std::vector<MicroBench> op_benchmarks();
std::vector<MicroBench> memory_benchmarks();
std::vector<MicroBench> flow_benchmarks();

}  // namespace glint::app
