// Declares the parameters of the caches of instructions and constants: the schedulers' L0, its prefetch, and
// the cache behind. Declares those of the instructions that come before a program's own, too.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/params.h"
#include "base/registry.h"
#include "memsys/replacement.h"

namespace glint::core {

// Volta and later have 128-bit instructions (Jia et al. 2018, section 2.1).
inline constexpr uint32_t kInstructionBytes = 16;
inline constexpr uint32_t kMaxPrefetch = 32;

// Holds the parameters of the schedulers' instruction caches. Defaults: "Analyzing Modern NVIDIA GPU cores",
// MICRO 2025, RTX A6000: section 5.2 and the configuration of its artifact.
struct FetchParams {
  bool perfect = false;
  uint32_t size = 16384;  // bytes for each scheduler: 4 sets of 32 lines
  uint32_t ways = 32;
  uint32_t prefetch = 8;                              // lines of a stream buffer (Jouppi, ISCA 1990)
  PolicyChoice<mem::Replacement> replacement{"lru"};  // Choice: unpublished
  static ParamList params() {
    return {
        flag(&FetchParams::perfect, "perfect", "True: every instruction is present when its warp needs it."),
        param(&FetchParams::size, "size", "byte", "Size of each scheduler's instruction cache (L0).", 128,
              1 << 20),
        param(&FetchParams::ways, "ways", "way",
              "Number of lines per set. 0: the cache is fully associative.", 0, 4096),
        policy(&FetchParams::replacement, "replacement",
               "Selects the line of a set that makes way for a new line in a scheduler's instruction cache."),
        param(&FetchParams::prefetch, "prefetch", "line",
              "Number of lines that the stream buffer fetches ahead of a miss. 0: it fetches none.", 0,
              kMaxPrefetch)};
  }
};

// Holds the parameters of the constant cache. Defaults: Turing T4, Jia et al. 2019, Table 3.1. Hits take the
// time of `units.const`.
struct ConstantParams {
  bool perfect = false;
  uint32_t size = 2048;
  uint32_t ways = 4;
  uint32_t line = 64;
  // The CUDA programming guide says that different addresses in a warp are served one after another.
  bool serial = true;
  uint32_t place_interval = 0, place_latency = 0;
  PolicyChoice<mem::Replacement> replacement{"lru"};  // Choice: unpublished
  static ParamList params() {
    return {
        flag(&ConstantParams::perfect, "perfect", "True: constant loads always hit."),
        param(&ConstantParams::size, "size", "byte", "Size of a core's constant cache (level 1).", 64,
              1 << 20),
        param(&ConstantParams::ways, "ways", "way",
              "Number of lines per set. 0: the cache is fully associative.", 0, 4096),
        policy(&ConstantParams::replacement, "replacement",
               "Selects the line of a set that makes way for a new line in the constant cache."),
        param(&ConstantParams::line, "line", "byte", "Size of a line. It is a power of two.", 32, 128),
        flag(&ConstantParams::serial, "serial",
             "True: a load takes a turn of the pipe for each different address that its lanes want."),
        param(&ConstantParams::place_interval, "place_interval", "cycle",
              "Cycles from one turn of a load to its next one, where loads take several turns. 0: it is the "
              "pipe's interval.",
              0, 64),
        param(&ConstantParams::place_latency, "place_latency", "cycle",
              "Cycles from the result of a load with one turn less to the result of a load with this turn. "
              "0: it "
              "is the pipe's interval.",
              0, 64)};
  }
};

// Holds the parameters of the cache behind the instruction and constant caches. The defaults are from the
// source that FetchParams names: 39 cycles to the cache and 39 back, and 79 for a constant that misses.
struct CodeCacheParams {
  uint32_t size = 131072;
  uint32_t ways = 16;  // Choice: unpublished
  uint32_t latency = 78;
  PolicyChoice<mem::Replacement> replacement{"lru"};  // Choice: unpublished
  static ParamList params() {
    return {
        param(&CodeCacheParams::size, "size", "byte",
              "Size of a core's cache for instructions and constants (level 1.5).", 1024, 1 << 24),
        param(&CodeCacheParams::ways, "ways", "way",
              "Number of lines per set. 0: the cache is fully associative.", 0, 4096),
        policy(&CodeCacheParams::replacement, "replacement",
               "Selects the line of a set that makes way for a new line in the cache for instructions and "
               "constants."),
        param(&CodeCacheParams::latency, "latency", "cycle",
              "Cycles from a miss in an instruction or constant cache to the line, when the cache behind "
              "them has it.",
              2, 1000)};
  }
};

// Holds the number of instructions that hardware executes before a kernel's own. An H200 executes 2, which
// read the stack pointer and the descriptor of global memory from constants, and 3 more in kernels with
// shared memory, which find the window of that memory. With these numbers, the counts of executed
// instructions of five kernels of 19 to 155 instructions come out exactly. The default is 0, because shaders
// of other parts have what they need in their code.
struct PrologueParams {
  uint32_t instructions = 0, shared_instructions = 0;
  static ParamList params() {
    return {param(&PrologueParams::instructions, "instructions", "instruction",
                  "Number of issue slots of each warp before its first instruction.", 0, 1000),
            param(&PrologueParams::shared_instructions, "shared_instructions", "instruction",
                  "Number of additional issue slots of each warp before its first instruction, "
                  "when the launch has shared memory.",
                  0, 1000)};
  }
};

}  // namespace glint::core
