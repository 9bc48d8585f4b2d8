// Traces warps of rays on an RT unit, keeps what came of it, and compares the hits.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {

// Compares two hits bit by bit.
inline bool same_hit(const Hit& a, const Hit& b) {
  return std::memcmp(&a.t, &b.t, 12) == 0 && a.kind == b.kind && a.instance == b.instance &&
         a.geometry == b.geometry && a.primitive == b.primitive;
}

inline void require_same_hits(const std::vector<WarpRays>& found, const std::vector<WarpRays>& expected) {
  REQUIRE(found.size() == expected.size());
  for (size_t w = 0; w < found.size(); ++w)
    for (size_t lane = 0; lane < kLanes; ++lane) {
      REQUIRE(found[w][lane].status == RayStatus::Done);
      REQUIRE(same_hit(found[w][lane].committed, expected[w][lane].committed));
    }
}

inline uint64_t num_hits(const std::vector<WarpRays>& warps) {
  uint64_t out = 0;
  for (const WarpRays& warp : warps)
    for (const RayState& ray : warp) out += ray.committed.valid();
  return out;
}

// Holds the rays at their ends, the cycle at which each warp was complete, and all statistics (listing()).
struct Traced {
  std::vector<WarpRays> rays;
  std::vector<Cycle> completion;
  std::string stats;

  // Returns the first counter of this name, or 0.
  uint64_t count(const std::string& name) const { return glint::test::counter_in(stats, name); }
};

// Returns where a unit keeps what it writes. Candidate tables have `table_rows` rows for each ray.
inline RtUnit::Context context_of(const mem::AddressSpace& memory, mem::FixedLatencyMemory& l1,
                                  stats::Group& root, uint32_t table_rows = 0) {
  return {memory,          l1, &root, Address{1} << 30, {Address{1} << 31, table_rows}, Address{1} << 32,
          Address{1} << 33};
}

// Traces rays that have begun. The unit is ticked every cycle or only at events.
inline Traced trace_rays(const Params& params, const mem::AddressSpace& memory, std::vector<WarpRays> rays,
                         mem::FixedLatencyMemory l1, bool every_cycle, uint32_t table_rows = 0) {
  Traced out{std::move(rays), {}, {}};
  stats::Group root(nullptr, "test");
  RtUnit unit(params, context_of(memory, l1, root, table_rows));
  const Launch done = launch(unit, l1, out.rays, every_cycle);
  unit.finish(done.last_completion + 1);
  out.completion = done.completion;
  out.stats = glint::test::listing(root);
  CHECK(unit.num_resident() == 0);
  return out;
}

}  // namespace glint::rt::test
