// The schedulers' instruction caches (L0), each with a stream buffer that fetches ahead.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/code_cache.h"

namespace glint::core {

// A warp asks for a line when it comes to it, and waits when it is not there.
// Model: a warp keeps the line that it is in, whatever its L0 drops (hardware buffers three instructions a
// warp); a fetch of one cycle is hidden, and the target of a branch is known when the branch issues.
class InstructionFetch {
 public:
  // `base`: physical address of instruction 0; `num_instructions` of the image: nothing is fetched past its
  // end.
  InstructionFetch(const FetchParams& params, uint32_t schedulers, Address base, size_t num_instructions,
                   CodeCache& cache, CodeStats& stats);

  uint32_t line_of(uint32_t pc) const { return pc / per_line_; }
  // Whether a warp of the scheduler can go on at once in `line`. If not it has been asked for, and arrive()
  // will tell.
  bool come_to(uint32_t scheduler, uint32_t line, Cycle now);
  // An answer of the cache for the scheduler: the line if a warp waits for it, else kNone.
  uint32_t arrive(uint32_t scheduler, Address address);
  static constexpr uint32_t kNone = ~0u;
  // Lines that all schedulers together may wait for: of each warp one, and those fetched ahead.
  static uint32_t most_in_flight(uint32_t schedulers);

 private:
  struct Ahead {
    uint32_t line = 0;
    bool here = false;
  };
  struct InFlight {
    uint32_t line = 0;
    bool wanted = false;  // by a warp
  };
  // Model: the stream buffer follows the last miss; hardware's replacement among streams is not published.
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
