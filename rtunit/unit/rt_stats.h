// Declares what an RT unit counts.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/stats.h"

namespace glint::rt {

// Says what a cycle of the unit was spent on. Each cycle has exactly one reason: the first of this list that
// holds.
enum class Stall : uint8_t {
  NodeRequest,    // The unit sent a request to the L1.
  L1Refused,      // It had a request, and the L1 did not take it.
  Prefetch,       // It sent a prefetch, because it had nothing else to send.
  MshrFull,       // A lane wants to read, and no entry is free.
  TestBusy,       // A node waits for a test pipeline.
  WaitingMemory,  // Nodes or entries of stacks are on their way.
  TestLatency,    // Only tests are in flight.
  Handover,       // A warp is being taken over or given back.
  Idle,           // The unit holds no warp.
  Count
};
constexpr std::string_view name_of(Stall s) {
  constexpr std::string_view kNames[] = {"node_request", "l1_refused", "prefetch",
                                         "mshr_full",    "test_busy",  "waiting_memory",
                                         "test_latency", "handover",   "idle"};
  static_assert(std::size(kNames) == size_t(Stall::Count));
  return kNames[size_t(s)];
}

struct RtStats : stats::Group {
  explicit RtStats(Group* parent) : Group(parent, "rt") {}
  stats::Breakdown<Stall> cycles{
      this, "cycles", "cycle",
      "Number of cycles of the unit, by what they were spent on. Every cycle has exactly one reason."};

  stats::Counter warps{
      this, "warps", "warp",
      "Number of warps that the unit accepted. A warp that comes back after shaders counts again."};
  stats::Counter rays{this, "rays", "ray", "Number of rays that the unit accepted for the first time."};
  stats::Counter first_hit_rays{this, "first_hit_rays", "ray",
                                "Number of rays that the unit accepted for the first time and that may end "
                                "at any hit (TerminateOnFirstHit)."};
  stats::Counter resumed{
      this, "resumed_rays", "ray",
      "Number of times that the unit accepted a ray again after an intersection or any-hit shader."};
  stats::Counter finished{this, "finished_rays", "ray",
                          "Number of rays whose traversal ended in the unit, not in a shader."};
  stats::Counter suspended{
      this, "suspended_rays", "ray",
      "Number of times that a ray was given back to run a shader before its traversal had ended."};

  stats::Counter internal_nodes{this, "internal_nodes", "node", "Number of internal nodes visited."};
  stats::Counter instance_leaves{this, "instance_leaves", "node", "Number of instance leaves visited."};
  stats::Counter triangle_leaves{this, "triangle_leaves", "node", "Number of triangle leaves visited."};
  stats::Counter procedural_leaves{this, "procedural_leaves", "node", "Number of procedural leaves visited."};
  stats::Counter nodes{this, "nodes", "node", "Number of nodes of all kinds visited."};
  stats::Ratio nodes_per_ray{
      this, "nodes_per_ray", "node/ray", nodes, rays, "Mean number of nodes that a ray visits."};
  stats::Counter box_tests{this, "box_tests", "test",
                           "Number of ray-box tests. Each child of a node counts."};
  stats::Counter triangle_tests{this, "triangle_tests", "test", "Number of ray-triangle tests."};

  stats::Counter fetches{this, "fetches", "node",
                         "Number of nodes that the unit asked for. Lanes that share a fetch count once."};
  stats::Counter headers{
      this, "headers", "lane",
      "Number of structure headers that lanes read on their own (rt.shortcuts.fetch_headers)."};
  stats::Counter descriptors{
      this, "descriptors", "lane",
      "Number of leaf descriptors that lanes read on their own (rt.shortcuts.fetch_descriptors)."};
  stats::Counter merged_lanes{this, "merged_lanes", "lane",
                              "Number of lanes that shared another lane's fetch."};
  stats::Counter merged_across{this, "merged_across", "lane",
                               "Number of lanes that shared the fetch of another warp's lane."};
  stats::Counter stale_nodes{
      this, "stale_nodes", "node",
      "Number of nodes visited though they lay behind the ray's hit (rt.retest = false)."};
  stats::Counter stack_spills{this, "stack_spills", "sector",
                              "Number of 32 B sectors of rays' stacks written to memory."};
  stats::Counter stack_fills{this, "stack_fills", "sector",
                             "Number of 32 B sectors of rays' stacks read back from memory."};
  stats::Counter restarts{
      this, "restarts", "ray",
      "Number of times that a ray began again at the root because its stack had forgotten entries."};
  stats::Counter restart_nodes{
      this, "restart_nodes", "node",
      "Number of nodes visited again after a restart. They are not counted as visited."};
  stats::Counter requests{this, "requests", "request",
                          "Number of read requests that the L1 took from the unit."};
  stats::Counter sectors{this, "sectors", "sector", "Number of 32 B sectors that the unit asked for."};
  stats::Counter refusals{this, "refusals", "request",
                          "Number of times that the L1 refused a request of the unit."};
  stats::Counter result_writes{this, "result_writes", "request",
                               "Number of write requests for results (rt.result_store)."};
  stats::Counter hit_writes{
      this, "hit_writes", "request",
      "Number of write requests for single hits and candidates (rt.shortcuts.store_each_hit)."};
  stats::Counter table_writes{this, "table_writes", "request",
                              "Number of write requests for candidates of the deferred any-hit mode."};
  stats::Counter table_entries{this, "table_entries", "candidate",
                               "Number of candidates of the deferred any-hit mode that the unit wrote."};

  stats::Counter unit_cycles{this, "unit_cycles", "cycle", "Number of cycles of the unit."};
  stats::Counter warp_cycles{this, "warp_cycles", "warp*cycle",
                             "Number of warps in the unit, summed over cycles."};
  stats::Counter lane_slots{
      this, "lane_slots", "lane*cycle",
      "Number of lanes of the warps in the unit, which is 32 per warp, summed over cycles."};
  stats::Counter ray_cycles{this, "ray_cycles", "ray*cycle",
                            "Number of rays in the unit that have not stopped, summed over cycles."};
  stats::Ratio occupancy{this,        "occupancy", "warp",
                         warp_cycles, unit_cycles, "Mean number of warps in the unit."};
  stats::Ratio efficiency{this,       "efficiency",
                          "ray/lane", ray_cycles,
                          lane_slots, "Share of the lanes in the unit whose ray has not stopped."};
  stats::Counter warp_latency_sum{this, "warp_latency_sum", "cycle",
                                  "Cycles from a warp's acceptance to its return, summed over warps."};
  stats::Ratio warp_latency{this,    "warp_latency",
                            "cycle", warp_latency_sum,
                            warps,   "Mean cycles from a warp's acceptance to its return."};
  stats::Histogram ray_latency{this, "ray_latency", "cycle", stats::linear(0, 20000, 500),
                               "Cycles from a ray's acceptance to its stop. The stays of a ray that comes "
                               "back count together, so each ray counts once."};
  stats::Histogram ray_nodes{
      this, "ray_nodes", "node", stats::linear(0, 512, 8),
      "Number of nodes that a ray visited on its whole walk, wherever that ended. Each ray counts once."};

  uint32_t most_nodes = 0, deepest_stack = 0;
  stats::Value max_ray_nodes{this,
                             "max_ray_nodes",
                             "node",
                             [this] { return double(most_nodes); },
                             "Largest number of nodes that one ray visited.",
                             [this](double other) { most_nodes = std::max(most_nodes, uint32_t(other)); }};
  stats::Value max_stack{this,
                         "max_stack",
                         "entry",
                         [this] { return double(deepest_stack); },
                         "Largest number of entries on a ray's stack.",
                         [this](double other) { deepest_stack = std::max(deepest_stack, uint32_t(other)); }};
};

}  // namespace glint::rt
