// Shortcuts of a published simulator's RT unit, each a switch: for comparisons with its results, not for
// hardware.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <tuple>

#include "base/params.h"

namespace glint::rt {

// All off by default. Source: Vulkan-Sim 2.0.0 (rt_unit in shader.cc, VulkanRayTracing::traceRay). None of
// them changes a hit. Its tests without limits are `units` of the pipelines in rt::Params, its order of
// children is rt.child_order = "first_internal", its pops of nodes behind the hit rt.retest = false.
struct Shortcuts {
  bool same_cycle_hits = false;
  bool fetch_headers = false;
  bool fetch_descriptors = false;
  bool store_each_hit = false;
  uint32_t store_latency = 0;                           // 0: a write is over when the L1 has taken it
  uint32_t header_latency = 4, descriptor_latency = 4;  // -gpgpu_rt_intersection_latency, entries 0 and 3

  static constexpr auto params() {
    return std::tuple{flag(&Shortcuts::same_cycle_hits, "same_cycle_hits",
                           "Answers of the L1 are also taken after the requests of a cycle: with "
                           "memory.l1.hit_latency = 0 a hit takes no time."),
                      flag(&Shortcuts::fetch_headers, "fetch_headers",
                           "A ray reads the 64 B header of a structure before its root: when it starts, and "
                           "at each instance that it enters."),
                      flag(&Shortcuts::fetch_descriptors, "fetch_descriptors",
                           "A ray reads the first 8 B of a triangle or procedural leaf on their own, and "
                           "then the leaf, those bytes included."),
                      flag(&Shortcuts::store_each_hit, "store_each_hit",
                           "Every triangle met within the ray's interval is stored at once, 32 B at the "
                           "start of 256 new ones, and every "
                           "procedural candidate twice; all before any node is asked for."),
                      param(&Shortcuts::store_latency, "store_latency", "cycle",
                            "With store_each_hit: a warp is not given back earlier than this after its last "
                            "store: the way of an acknowledgement.",
                            0, 10000),
                      param(&Shortcuts::header_latency, "header_latency", "cycle",
                            "With fetch_headers: from a header's arrival to the next fetch.", 1, 1000),
                      param(&Shortcuts::descriptor_latency, "descriptor_latency", "cycle",
                            "With fetch_descriptors: from its arrival to the next fetch.", 1, 1000)};
  }
};

}  // namespace glint::rt
