// Drives an RT unit against a memory of fixed latency, cycle by cycle or from event to event.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <vector>

#include "rtunit/unit/rt_unit.h"
#include "tests/support/fixed_latency_memory.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {

using WarpRays = std::array<RayState, kLanes>;

// Does what a core does in these tests with a ray that needs a shader: decides by a fixed rule of the
// candidate's primitive.
inline void decide(RayState& state) {
  while (state.status == RayStatus::NeedsAnyHit || state.status == RayStatus::NeedsIntersection) {
    if (state.status == RayStatus::NeedsAnyHit) {
      state.candidate.primitive % 3 ? accept_candidate(state) : ignore_candidate(state);
      continue;
    }
    const float t = state.candidate.t + 0.01f * float(state.candidate.primitive % 5);
    if (report(state, t, state.candidate.primitive & 0x7f) == Report::NeedsAnyHit)
      state.candidate.primitive % 3 ? accept_candidate(state) : ignore_candidate(state);
    finish_intersection(state);
  }
}

// Decides until the ray goes on. Tables are read from the first row on.
inline void resolve(RayState& state) {
  decide(state);
  while (state.status == RayStatus::Gathered) {
    present(state, uint32_t(std::countr_zero(state.table->used)));
    decide(state);
  }
}

inline void run_to_end(RayState& state, const mem::AddressSpace& memory) {
  while (state.status != RayStatus::Done) {
    run(state, memory);
    resolve(state);
  }
}

inline std::vector<WarpRays> one_lane(const RayState& ray) {
  std::vector<WarpRays> out(1);
  out[0][5] = ray;
  return out;
}

struct Launch {
  Cycle last_completion = 0;
  std::vector<Cycle> completion;  // completion of each warp, the last one
  uint64_t completions = 0;
};

// Runs all warps to their ends, and submits them in order as soon as there is room. The unit is ticked every
// cycle or only at events.
inline Launch launch(RtUnit& unit, mem::FixedLatencyMemory& l1, std::vector<WarpRays>& warps,
                     bool every_cycle, Cycle limit = 10'000'000) {
  Launch out;
  out.completion.resize(warps.size());
  std::deque<uint32_t> waiting;
  for (uint32_t w = 0; w < warps.size(); ++w) waiting.push_back(w);
  uint32_t busy = 0;
  for (Cycle now = 0; (busy || !waiting.empty()) && now < limit;) {
    l1.tick(now);
    unit.tick(now);
    while (const auto warp = unit.pop_completion(now)) {
      --busy;
      ++out.completions;
      out.completion[*warp] = out.last_completion = now;
      bool again = false;
      for (RayState& state : warps[*warp]) {
        resolve(state);
        again |= state.status == RayStatus::Traversing;
      }
      if (again) waiting.push_back(*warp);
    }
    while (!waiting.empty() && unit.can_accept()) {
      const uint32_t w = waiting.front();
      waiting.pop_front();
      LaneMask mask = 0;
      for (int lane = 0; lane < kLanes; ++lane)
        if (warps[w][size_t(lane)].status == RayStatus::Traversing) mask |= LaneMask{1} << lane;
      if (mask == 0) continue;
      unit.submit(now, w, mask, warps[w].data());
      ++busy;
    }
    const Cycle next = std::min(unit.next_event(now), l1.next_event(now + 1));
    now = every_cycle || next == kNever ? now + 1 : next;
  }
  return out;
}

}  // namespace glint::rt::test
