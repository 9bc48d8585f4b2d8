// Models the schedulers' instruction caches (L0), each with a stream buffer that fetches ahead.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/code_cache.h"

namespace glint::core {

// Serves warps. A warp asks for a line when it comes to it, and waits when the line is not present. Model: a
// warp keeps the line that it is in, whatever its L0 drops (hardware buffers three instructions per warp). A
// fetch of one cycle is hidden, and the target of a branch is known when the branch issues.
class InstructionFetch {
 public:
  // `base` is the physical address of instruction 0, and `num_instructions` is the image's number of
  // instructions. Nothing is fetched past its end.
  InstructionFetch(const FetchParams& params, uint32_t schedulers, Address base, size_t num_instructions,
                   CodeCache& cache, CodeStats& stats);

  uint32_t line_of(uint32_t pc) const { return pc / per_line_; }
  // Returns whether a warp of the scheduler can go on at once in `line`. If not, the line has been asked for,
  // and arrive() tells when it comes.
  bool come_to(uint32_t scheduler, uint32_t line, Cycle now);
  // Takes an answer of the cache for the scheduler. Returns the line if a warp waits for it, else kNone.
  uint32_t arrive(uint32_t scheduler, Address address);
  static constexpr uint32_t kNone = ~0u;
  // Returns the number of lines that all schedulers together may wait for: one of each warp, and those
  // fetched ahead.
  static uint32_t most_in_flight(uint32_t schedulers);

 private:
  struct Ahead {
    uint32_t line = 0;
    bool here = false;
  };
  struct InFlight {
    uint32_t line = 0;
    bool wanted = false;  // A warp waits for it.
  };
  // Holds one L0. Model: the stream buffer follows the last miss; hardware's replacement among streams is not
  // published.
  struct L0 {
    explicit L0(mem::TagArray tags_of) : tags(std::move(tags_of)) {}
    mem::TagArray tags;
    std::array<Ahead, kMaxPrefetch> ahead{};  // consecutive lines, oldest first
    uint32_t num_ahead = 0;
    std::vector<InFlight> in_flight;
  };

  Address address_of(uint32_t line) const { return base_ + Address{line} * cache_.line_bytes(); }
  void run_ahead(L0& l0, uint32_t scheduler, uint32_t line, Cycle now);
  void ask(L0& l0, uint32_t scheduler, uint32_t line, bool wanted, Cycle now);

  const uint32_t prefetch_, per_line_, num_lines_;
  const Address base_;
  CodeCache& cache_;
  CodeStats& stats_;
  std::vector<L0> l0_;
};

}  // namespace glint::core
