// Tunables of an RT unit: warp buffer, request port, test pipelines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/params.h"
#include "base/registry.h"
#include "rtunit/any_hit_mode.h"
#include "rtunit/child_order.h"
#include "rtunit/coalescer.h"
#include "rtunit/ray_scheduler.h"
#include "rtunit/shortcuts/shortcuts.h"
#include "rtunit/stack_model.h"

namespace glint::rt {

// A pipeline that tests nodes: in each `interval` it starts `units` tests, each done after `latency`.
struct PipelineParams {
  uint32_t latency = 1, interval = 1, units = 1;
  static constexpr auto params() {
    return std::tuple{
        param(&PipelineParams::latency, "latency", "cycle", "From the start of a test to its result.", 1,
              1000),
        param(&PipelineParams::interval, "interval", "cycle",
              "From a start to the next start on the same unit.", 1, 1000),
        param(&PipelineParams::units, "units", "unit", "Tests that can start together.", 1, 4096)};
  }
};

// Who walks rays.
inline constexpr std::string_view kHardware = "hardware", kSoftware = "software";
inline std::vector<std::string> unit_names() {
  return {std::string(kHardware), std::string(kSoftware)};
}

struct Params {
  std::string unit{kHardware};
  uint32_t warps = 4;               // Vulkan-Sim 2.0, -gpgpu_rt_max_warps, both shipped configurations
  uint32_t requests_per_cycle = 1;  // Vulkan-Sim: one request a cycle
  uint32_t request_bytes = 64;      // Choice: a node in one request; Vulkan-Sim sends 32
  uint32_t responses_per_cycle = 1;
  uint32_t mshr_entries = 64;      // Vulkan-Sim has the key -gpgpu_rt_max_mshr_entries 64 and no effect
  uint32_t retires_per_cycle = 1;  // Vulkan-Sim: one warp a cycle
  // Choice: which hit a ray with TerminateOnFirstHit gets depends on the order of traversal; the nearest does
  // not, so that no policy changes a picture. Hardware ends at the first one found, and visits up to a fifth
  // fewer nodes.
  bool nearest_first_hit = true;
  bool retest = true;         // Choice: stacks keep the distance; Vulkan-Sim's does not
  bool result_store = false;  // Choice: results go to registers; Vulkan-Sim stores 32 B a hit
  // A node of six boxes a cycle after 13, a triangle every second cycle after 37: estimates for a
  // Turing-class unit; vendors publish rates (AMD RDNA3: 4 boxes and 1 triangle a cycle; Intel Xe-HPG: 12 and
  // 1) but no latencies.
  PipelineParams box{13, 1, 1}, triangle{37, 2, 1};
  PipelineParams transform{8, 1, 1};  // latency: Vulkan-Sim, instance leaf
  PolicyChoice<RayScheduler> scheduler{"oldest_first"};
  PolicyChoice<AnyHitMode> any_hit{"immediate"};
  PolicyChoice<ChildOrder> child_order{"near_first"};
  PolicyChoice<Coalescer> coalescing{"within_warp"};
  PolicyChoice<StackModel> stack{"short_stack"};
  Shortcuts shortcuts;
  static constexpr auto params() {
    return std::tuple{
        choice(&Params::unit, "unit",
               "Who walks rays: the RT unit of the keys below, or the core's own code, as ordinary "
               "instructions (shaders/traversal).",
               &unit_names),
        param(&Params::warps, "warps", "warp", "Warps in the unit's buffer.", 1, 64),
        param(&Params::requests_per_cycle, "requests_per_cycle", "request",
              "Requests sent to the L1 a cycle.", 1, 16),
        param(&Params::request_bytes, "request_bytes", "B", "Largest request; a multiple of the 32 B sector.",
              32, 128),
        param(&Params::responses_per_cycle, "responses_per_cycle", "response",
              "Answers taken from the L1 a cycle.", 1, 64),
        param(&Params::mshr_entries, "mshr_entries", "entry",
              "Nodes (and sectors of stacks) that wait for the L1 at once; 0: as many as the unit has lanes.",
              0, 2048),
        param(&Params::retires_per_cycle, "retires_per_cycle", "warp",
              "Warps given back to the core a cycle.", 1, 64),
        flag(&Params::result_store, "result_store",
             "Write 32 B a ray through the L1 before its warp is given back."),
        flag(&Params::nearest_first_hit, "nearest_first_hit",
             "Rays that may end at any hit look for the nearest, so that their result is independent of "
             "traversal order."),
        flag(&Params::retest, "retest",
             "A node that comes up from the stack behind the hit found since is dropped, not visited."),
        section(&Params::box, "box", "Tests of internal nodes and of AABBs; one test a node."),
        section(&Params::triangle, "triangle", "Ray-triangle tests; one test a triangle."),
        section(&Params::transform, "transform", "Transforms of rays to object space; one test an instance."),
        policy(&Params::scheduler, "scheduler", "Which resident warp sends a node request."),
        policy(&Params::any_hit, "any_hit",
               "When intersection and any-hit shaders run: at each candidate, or over a table after the "
               "traversal."),
        policy(&Params::child_order, "child_order", "In which order a ray visits the children that it hits."),
        policy(&Params::coalescing, "coalescing", "Which lanes that want the same node share its fetch."),
        policy(&Params::stack, "stack", "Where the nodes that a ray still has to visit are kept."),
        section(&Params::shortcuts, "shortcuts",
                "What Vulkan-Sim does otherwise than hardware: for comparisons with it.")};
  }
};

}  // namespace glint::rt
