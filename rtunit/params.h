// Declares the parameters of an RT unit: those of its warp buffer, request port and test pipelines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "base/registry.h"
#include "rtunit/any_hit_mode.h"
#include "rtunit/child_order.h"
#include "rtunit/coalescer.h"
#include "rtunit/leaf_filter.h"
#include "rtunit/node_test.h"
#include "rtunit/prefetcher.h"
#include "rtunit/ray_entry.h"
#include "rtunit/ray_pool.h"
#include "rtunit/ray_scheduler.h"
#include "rtunit/shortcuts/shortcuts.h"
#include "rtunit/stack_model.h"
#include "rtunit/traversal_order.h"
#include "rtunit/work_mapping.h"

namespace glint::rt {

// Describes a pipeline that tests nodes. It starts `units` tests in each `interval`, and each test takes
// `latency`.
struct PipelineParams {
  uint32_t latency = 1, interval = 1, units = 1;
  static ParamList params() {
    return {param(&PipelineParams::latency, "latency", "cycle",
                  "Cycles from the start of a test to its result.", 1, 1000),
            param(&PipelineParams::interval, "interval", "cycle",
                  "Cycles from the start of a test to the next start on the same unit.", 1, 1000),
            param(&PipelineParams::units, "units", "unit",
                  "Number of tests that can start in the same cycle.", 1, 4096)};
  }
};

// Switches that give the unit what no hardware can have. Each bounds what a kind of idea can gain.
struct Oracle {
  bool fetch_hits = false, any_lane = false;
  static ParamList params() {
    return {flag(&Oracle::fetch_hits, "fetch_hits",
                 "True: every node that a ray asks for is in the L1 already and moves no bytes, which bounds "
                 "what prefetching can gain. False: nodes come through the L1."),
            flag(&Oracle::any_lane, "any_lane",
                 "True: the unit takes a warp as soon as one of its `rt.warps` x 32 lanes has no ray, which "
                 "bounds what forming warps anew can gain. False: a warp's lanes are free when its last ray "
                 "has stopped.")};
  }
};

// These are the values of rt.unit, which says who walks rays.
inline constexpr std::string_view kHardware = "hardware", kSoftware = "software";
inline std::vector<std::string> unit_names() {
  return {std::string(kHardware), std::string(kSoftware)};
}

inline constexpr uint32_t kMostWarps = 64;  // that the unit can hold, because masks of them have 64 bits

struct Params {
  std::string unit{kHardware};
  uint32_t warps = 4;               // Vulkan-Sim 2.0, -gpgpu_rt_max_warps, both shipped configurations
  uint32_t requests_per_cycle = 1;  // Vulkan-Sim sends one request per cycle
  uint32_t request_bytes = 64;      // Choice: a node takes one request; Vulkan-Sim sends 32 B
  uint32_t responses_per_cycle = 1;
  uint32_t mshr_entries = 64;      // Vulkan-Sim has -gpgpu_rt_max_mshr_entries 64 without effect
  uint32_t retires_per_cycle = 1;  // Vulkan-Sim gives back one warp per cycle
  // Choice: a ray with TerminateOnFirstHit takes the nearest hit. Which hit is found first depends on the
  // order of traversal; the nearest does not, so no policy changes a picture. Hardware ends at the first hit
  // found, and visits up to a fifth fewer nodes.
  bool nearest_first_hit = true;
  bool retest = true;         // Choice: stacks keep distances; Vulkan-Sim's does not
  bool result_store = false;  // Choice: results go to registers; Vulkan-Sim stores 32 B
  // The unit tests a node of six boxes each cycle, in 13 cycles, and a triangle every second cycle, in 37.
  // These are estimates for a Turing-class unit: vendors publish rates (AMD RDNA3: 4 boxes and 1 triangle a
  // cycle; Intel Xe-HPG: 12 and 1) but no latencies.
  PipelineParams box{13, 1, 1}, triangle{37, 2, 1};
  PipelineParams transform{8, 1, 1};  // The latency is Vulkan-Sim's for an instance leaf
  PolicyChoice<NodeTest> node_test{"by_node"};
  PolicyChoice<RayScheduler> scheduler{"oldest_first"};
  PolicyChoice<AnyHitMode> any_hit{"immediate"};
  PolicyChoice<LeafFilter> leaf_filter{"none"};
  PolicyChoice<ChildOrder> child_order{"near_first"};
  PolicyChoice<TraversalOrder> order{"depth_first"};
  PolicyChoice<Coalescer> coalescing{"within_warp"};
  PolicyChoice<StackModel> stack{"short_stack"};
  PolicyChoice<WorkMapping> mapping{"own_ray"};
  PolicyChoice<RayEntry> entry{"root"};
  PolicyChoice<RayPool> pool{"none"};
  uint32_t pool_warps = 16;  // Choice: as many as wait for the unit in a core that is full of thin warps
  bool pool_stacks = true;
  PolicyChoice<Prefetcher> prefetch{"none"};
  uint32_t prefetch_queue =
      512;  // Choice: 16 entries for each lane of a warp; the published one has no bound
  Oracle oracle;
  Shortcuts shortcuts;
  static ParamList params() {
    ParamList rows = stage_params();
    const ParamList choices = choice_params();
    rows.insert(rows.end(), choices.begin(), choices.end());
    return rows;
  }
  // Returns the number of slots of the warp buffer.
  uint32_t slots() const { return oracle.any_lane ? kMostWarps : warps; }
  static ParamList stage_params() {
    return {
        choice(&Params::unit, "unit",
               "Selects who walks rays: the RT unit, which the other keys under `rt` describe, or ordinary "
               "instructions of the core (shaders/traversal).",
               &unit_names),
        param(&Params::warps, "warps", "warp", "Number of warps that the unit holds at once.", 1, kMostWarps),
        param(&Params::requests_per_cycle, "requests_per_cycle", "request",
              "Largest number of requests sent to the L1 in a cycle.", 1, 16),
        param(&Params::request_bytes, "request_bytes", "byte",
              "Largest number of bytes that one request reads. It is a multiple of the 32 B sector.", 32,
              128),
        param(&Params::responses_per_cycle, "responses_per_cycle", "response",
              "Largest number of answers taken from the L1 in a cycle.", 1, 64),
        param(&Params::mshr_entries, "mshr_entries", "entry",
              "Largest number of nodes and stack sectors that wait for the L1 at once. 0: only the number of "
              "lanes limits it.",
              0, 2048),
        param(&Params::retires_per_cycle, "retires_per_cycle", "warp",
              "Largest number of warps given back to the core in a cycle.", 1, 64),
        flag(&Params::result_store, "result_store",
             "True: the unit writes 32 B per ray through the L1 before it gives the warp back. False: "
             "results go to registers."),
        flag(&Params::nearest_first_hit, "nearest_first_hit",
             "True: rays that may end at any hit look for the nearest hit, so that their result does not "
             "depend on the traversal order. False: they end at the first hit."),
        flag(&Params::retest, "retest",
             "True: the unit drops a node from the stack, without a visit, when a nearer hit was found "
             "since. False: it visits the node."),
        section(&Params::box, "box",
                "Parameters of the pipeline that tests internal nodes and AABBs. A node is one test."),
        section(&Params::triangle, "triangle",
                "Parameters of the pipeline that tests triangles. A triangle is one test."),
        section(&Params::transform, "transform",
                "Parameters of the pipeline that transforms rays to object space. An instance is one test.")};
  }
  static ParamList choice_params() {
    return {
        policy(&Params::node_test, "node_test",
               "Selects how many starts of its pipeline the test of a node takes."),
        policy(&Params::scheduler, "scheduler", "Selects which warp of the unit sends a node request."),
        policy(&Params::any_hit, "any_hit",
               "Selects when intersection and any-hit shaders run: at each candidate, or over a table after "
               "the traversal."),
        policy(&Params::leaf_filter, "leaf_filter",
               "Selects what decides candidates that are not opaque before a shader is asked."),
        policy(&Params::child_order, "child_order",
               "Selects the order in which a ray visits the children that it hits."),
        policy(&Params::order, "order", "Selects which of its open nodes a ray visits next."),
        policy(&Params::coalescing, "coalescing",
               "Selects which lanes that want the same node share its fetch."),
        policy(&Params::stack, "stack", "Selects where a ray keeps the nodes that it still has to visit."),
        policy(&Params::mapping, "mapping",
               "Selects which lanes visit nodes for the rays of other lanes of their warp."),
        policy(&Params::entry, "entry", "Selects where a ray begins its walk."),
        policy(&Params::pool, "pool", "Selects which rays form the warps of the unit."),
        param(&Params::pool_warps, "pool_warps", "warp",
              "Number of the core's warps whose rays the unit accepts at once, with a pool.", 1, 128),
        flag(
            &Params::pool_stacks, "pool_stacks",
            "True: a ray that goes back to the pool takes the entries of its stack along, as far as they fit "
            "into a line. False: 32 B move."),
        policy(&Params::prefetch, "prefetch", "Selects which nodes are read before a ray asks for them."),
        param(&Params::prefetch_queue, "prefetch_queue", "sector",
              "Largest number of sectors that wait to be read ahead.", 1, 65536),
        section(&Params::oracle, "oracle",
                "Switches that give the unit what no hardware can have, to bound what an idea can gain."),
        section(
            &Params::shortcuts, "shortcuts",
            "Switches that make the unit behave as Vulkan-Sim does and hardware does not, for comparisons.")};
  }
};

}  // namespace glint::rt
