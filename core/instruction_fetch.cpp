// Implements the schedulers' instruction caches.
// SPDX-License-Identifier: Apache-2.0
#include "core/instruction_fetch.h"

#include <algorithm>
#include <utility>

#include "core/params.h"

namespace glint::core {

InstructionFetch::InstructionFetch(const FetchParams& params, uint32_t schedulers, Address base,
                                   size_t num_instructions, CodeCache& cache, CodeStats& stats)
    : prefetch_(params.prefetch),
      per_line_(cache.line_bytes() / kInstructionBytes),
      num_lines_(uint32_t((num_instructions + per_line_ - 1) / per_line_)),
      base_(base),
      cache_(cache),
      stats_(stats) {
  for (uint32_t s = 0; s < schedulers; ++s) {
    l0_.emplace_back(
        mem::TagArray(mem::cache_shape(params.size, params.ways, cache.line_bytes()), params.replacement));
    l0_.back().in_flight.reserve(most_in_flight(1));
  }
}

// Returns the most lines that may be in flight: one for each warp, those of the present stream, and as many
// of streams that were given up.
uint32_t InstructionFetch::most_in_flight(uint32_t schedulers) {
  return schedulers * (kMaxWarps + 2 * kMaxPrefetch);
}

bool InstructionFetch::come_to(uint32_t scheduler, uint32_t line, Cycle now) {
  L0& l0 = l0_[scheduler];
  ++stats_.lines;
  if (const uint32_t slot = l0.tags.find(address_of(line)); slot != mem::TagArray::kNone) {
    l0.tags.touch(slot);
    return true;
  }
  // The line and those before it leave the stream, or all of them when the line is not in it.
  const auto first = l0.ahead.begin(), last = first + l0.num_ahead;
  const auto found = std::find_if(first, last, [line](const Ahead& ahead) { return ahead.line == line; });
  const bool here = found != last && found->here;
  l0.num_ahead = found == last ? 0 : uint32_t(std::move(found + 1, last, first) - first);
  if (here) {
    ++stats_.prefetch_hits;
    l0.tags.keep(address_of(line));
  } else {
    ++stats_.misses;
    ask(l0, scheduler, line, true, now);
  }
  run_ahead(l0, scheduler, line, now);
  return here;
}

// Fills the stream up with the lines after `line`.
void InstructionFetch::run_ahead(L0& l0, uint32_t scheduler, uint32_t line, Cycle now) {
  uint32_t next = l0.num_ahead ? l0.ahead[l0.num_ahead - 1].line + 1 : line + 1;
  for (; l0.num_ahead < prefetch_ && next < num_lines_; ++next) {
    const bool here = l0.tags.find(address_of(next)) != mem::TagArray::kNone;
    // Lines of streams that were given up may still be on the way, and there is no room to wait for many
    // more.
    if (!here && l0.in_flight.size() + kMaxWarps >= most_in_flight(1)) return;
    l0.ahead[l0.num_ahead++] = {next, here};
    if (here) continue;
    ++stats_.prefetches;
    ask(l0, scheduler, next, false, now);
  }
}

void InstructionFetch::ask(L0& l0, uint32_t scheduler, uint32_t line, bool wanted, Cycle now) {
  for (InFlight& flight : l0.in_flight)
    if (flight.line == line) {
      flight.wanted |= wanted;
      return;
    }
  l0.in_flight.push_back({line, wanted});
  cache_.ask(scheduler, address_of(line), mem::Traffic::Instruction, now);
}

uint32_t InstructionFetch::arrive(uint32_t scheduler, Address address) {
  L0& l0 = l0_[scheduler];
  const auto line = uint32_t((address - base_) / cache_.line_bytes());
  const auto flight = std::find_if(l0.in_flight.begin(), l0.in_flight.end(),
                                   [line](const InFlight& f) { return f.line == line; });
  const bool wanted = flight->wanted;
  *flight = l0.in_flight.back();
  l0.in_flight.pop_back();
  for (uint32_t i = 0; i < l0.num_ahead; ++i) l0.ahead[i].here |= l0.ahead[i].line == line;
  if (!wanted) return kNone;
  l0.tags.keep(address_of(line));
  return line;
}

}  // namespace glint::core
