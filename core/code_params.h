// Tunables of what feeds a core with instructions and constants: the schedulers' L0, their prefetch, the
// cache behind.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <tuple>

#include "base/params.h"
#include "base/registry.h"
#include "memsys/replacement.h"

namespace glint::core {

inline constexpr uint32_t kInstructionBytes =
    16;  // Volta and later: 128-bit instructions (Jia et al. 2018, section 2.1)
inline constexpr uint32_t kMaxPrefetch = 32;

// Defaults: "Analyzing Modern NVIDIA GPU cores", MICRO 2025, RTX A6000: section 5.2 and the configuration of
// its artifact.
struct FetchParams {
  bool perfect = false;
  uint32_t size = 16384;  // of each scheduler: 4 sets of 32 lines
  uint32_t ways = 32;
  uint32_t prefetch = 8;                              // stream buffer (Jouppi, ISCA 1990)
  PolicyChoice<mem::Replacement> replacement{"lru"};  // Choice: unpublished
  static constexpr auto params() {
    return std::tuple{
        flag(&FetchParams::perfect, "perfect", "Every instruction is there when its warp comes to it."),
        param(&FetchParams::size, "size", "byte", "Instruction cache of each scheduler (L0).", 128, 1 << 20),
        param(&FetchParams::ways, "ways", "way", "Lines a set of it; 0: fully associative.", 0, 4096),
        policy(&FetchParams::replacement, "replacement",
               "Which line of a set of a scheduler's instruction cache makes way for a new line."),
        param(&FetchParams::prefetch, "prefetch", "line",
              "Lines that its stream buffer fetches ahead of a miss; 0: none.", 0, kMaxPrefetch)};
  }
};

// Defaults: Turing T4, Jia et al. 2019, Table 3.1; its hits take `units.const`.
struct ConstantParams {
  bool perfect = false;
  uint32_t size = 2048;
  uint32_t ways = 4;
  uint32_t line = 64;
  bool serial = true;  // CUDA programming guide: different addresses in a warp are served one after another
  PolicyChoice<mem::Replacement> replacement{"lru"};  // Choice: unpublished
  static constexpr auto params() {
    return std::tuple{
        flag(&ConstantParams::perfect, "perfect", "Constant loads always hit."),
        param(&ConstantParams::size, "size", "byte", "Constant cache of a core (level 1).", 64, 1 << 20),
        param(&ConstantParams::ways, "ways", "way", "Lines a set; 0: fully associative.", 0, 4096),
        policy(&ConstantParams::replacement, "replacement",
               "Which line of a set of the constant cache makes way for a new line."),
        param(&ConstantParams::line, "line", "byte", "Line size: a power of two.", 32, 128),
        flag(&ConstantParams::serial, "serial",
             "A load takes the pipe's interval for each different word that its lanes want.")};
  }
};

// Behind both. Defaults: as FetchParams; 39 cycles there and 39 back, and 79 for a constant that misses.
struct CodeCacheParams {
  uint32_t size = 131072;
  uint32_t ways = 16;  // Choice: unpublished
  uint32_t latency = 78;
  PolicyChoice<mem::Replacement> replacement{"lru"};  // Choice: unpublished
  static constexpr auto params() {
    return std::tuple{
        param(&CodeCacheParams::size, "size", "byte",
              "Cache of a core for instructions and constants (level 1.5).", 1024, 1 << 24),
        param(&CodeCacheParams::ways, "ways", "way", "Lines a set; 0: fully associative.", 0, 4096),
        policy(&CodeCacheParams::replacement, "replacement",
               "Which line of a set of this cache makes way for a new line."),
        param(&CodeCacheParams::latency, "latency", "cycle",
              "From a miss above to the line, when it is here.", 2, 1000)};
  }
};

}  // namespace glint::core
