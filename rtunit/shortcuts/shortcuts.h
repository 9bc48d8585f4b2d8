// Declares switches that make the RT unit take the shortcuts of a published simulator, for comparisons with
// its results.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/params.h"

namespace glint::rt {

// All are off by default, and none of them changes a hit. Source: Vulkan-Sim 2.0.0 (rt_unit in shader.cc,
// VulkanRayTracing::traceRay). Its other traits are ordinary parameters: tests without limits are `units` of
// the pipelines in rt::Params, its order of children is rt.child_order = "first_internal", and its visits of
// nodes behind the hit are rt.retest = false.
struct Shortcuts {
  bool same_cycle_hits = false;
  bool fetch_headers = false;
  bool fetch_descriptors = false;
  bool store_each_hit = false;
  uint32_t store_latency = 0;                           // 0: a write ends when the L1 has taken it.
  uint32_t header_latency = 4, descriptor_latency = 4;  // -gpgpu_rt_intersection_latency, entries 0 and 3

  static ParamList params() {
    return {
        flag(&Shortcuts::same_cycle_hits, "same_cycle_hits",
             "True: the unit takes answers of the L1 also after it has sent the requests of a cycle, so that "
             "a hit takes no time with memory.l1.hit_latency = 0."),
        flag(&Shortcuts::fetch_headers, "fetch_headers",
             "True: a ray reads the 64 B header of a structure before the root, when it starts and at each "
             "instance that it enters."),
        flag(&Shortcuts::fetch_descriptors, "fetch_descriptors",
             "True: a ray reads the first 8 B of a triangle or procedural leaf on their own, and then the "
             "whole leaf."),
        flag(&Shortcuts::store_each_hit, "store_each_hit",
             "True: the unit stores every triangle that a ray meets within its interval at once, and every "
             "candidate of the deferred any-hit mode twice. A store writes 32 B at the start of 256 new "
             "bytes and is sent before any node is asked for."),
        param(&Shortcuts::store_latency, "store_latency", "cycle",
              "Cycles from a warp's last store to its acknowledgement, before which the warp is "
              "not given back. It has an effect only with store_each_hit.",
              0, 10000),
        param(&Shortcuts::header_latency, "header_latency", "cycle",
              "Cycles from the arrival of a header to the next fetch. It has an effect only with "
              "fetch_headers.",
              1, 1000),
        param(&Shortcuts::descriptor_latency, "descriptor_latency", "cycle",
              "Cycles from the arrival of a descriptor to the next fetch. It has an effect only "
              "with fetch_descriptors.",
              1, 1000)};
  }
};

}  // namespace glint::rt
