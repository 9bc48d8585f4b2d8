// Every metric once: name, unit, meaning, formula, where the paper shows it.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/metrics.h"

namespace glint::report {
namespace {

constexpr std::string_view kNoStoreQueue =
    "Glint's RT unit has no store queue: results go to registers, table writes are sent at once.";

constexpr Metric kGpu[] = {
    {"cycles", "cycle", "The launch, core clock.", "sum(gpu.cycles)", "Fig. 7 (PT)"},
    {"insn", "lane instruction", "Instructions that lanes executed.", "sum(core.lane_instructions)", ""},
    {"ipc", "lane instruction/cycle",
     "Lane instructions a cycle of the whole GPU, as GPGPU-Sim's gpu_tot_ipc; up to 32 times the warp "
     "instructions a cycle that `glint run` shows as IPC.",
     "sum(core.lane_instructions) / sum(gpu.cycles)", "Fig. 14, Fig. 6"},
    {"occupancy", "fraction", "Resident warps of the warp slots.",
     "sum(core.resident_cycles) / sum(core.slot_cycles)", ""},
    {"simt_efficiency", "fraction", "Lanes that execute of 32, averaged over warp instructions.",
     "sum(core.lane_instructions) / (32 * sum(core.instructions))", "Fig. 9 (bottom)"},
    {"sim_rate", "lane instruction/s",
     "Simulation speed on the host. The only metric that differs from run to run.",
     "sum(core.lane_instructions) / run(wall_seconds)", ""},
    {"stall_dramfull", "cycle",
     "Cycles that L2 slices could not serve a request because the DRAM queue was full, summed.",
     "sum(l2.cycles::queue_full)", ""},
    {"stall_icnt2sh", "cycle",
     "Cycles that replies waited for the network's port at their L2 slice, summed over replies (Vulkan-Sim "
     "counts cycles with any waiting).",
     "sum(l2.reply_wait)", ""},
    {"partition_parallelism", "request/cycle", "Requests that all L2 slices served a cycle.",
     "(sum(l2.reads::*) + sum(l2.writes::*)) / sum(gpu.cycles)", ""},
    {"l2_bw", "GB/s", "Replies of the L2, headers included.",
     "sum(l2.reply_bytes) / sum(gpu.cycles) * config(clock_mhz) / 1000", ""},
    {"w_icount", "warp instruction", "Warp instructions issued.", "sum(core.instructions)", "Fig. 8 (top)"},
    {"thrd_icount", "lane instruction", "The same as insn: two names in Vulkan-Sim.",
     "sum(core.lane_instructions)", ""},
    {"shd_mem_stalls", "cycle",
     "Scheduler cycles in which an instruction was ready and the memory queue was full.",
     "sum(core.issue_slots::lsu_throttle)", ""},
    {"ins_alu%", "%", "Share of warp instructions: integer, floating point, moves, predicates.",
     "100 * sum(core.instructions_by_class::alu) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_sfu%", "%", "Share of warp instructions: transcendentals and divisions.",
     "100 * sum(core.instructions_by_class::sfu) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_mem%", "%", "Share of warp instructions: loads, stores, atomics.",
     "100 * sum(core.instructions_by_class::mem) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_tex%", "%", "Share of warp instructions: textures and images.",
     "100 * sum(core.instructions_by_class::tex) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_ctrl%", "%", "Share of warp instructions: branches, calls, barriers.",
     "100 * sum(core.instructions_by_class::ctrl) / sum(core.instructions)", "Fig. 8 (top)"},
    {"lat_alu%", "%",
     "Share of the cycles from issue to completion, summed over warp instructions: integer, floating point, "
     "moves, predicates.",
     "100 * sum(core.latency_by_class::alu) / sum(core.latency_by_class::*)", "Fig. 8 (bottom)"},
    {"lat_mem%", "%",
     "Share of the cycles from issue to completion, summed over warp instructions: loads, stores, atomics.",
     "100 * sum(core.latency_by_class::mem) / sum(core.latency_by_class::*)", "Fig. 8 (bottom)"},
    {"local_loads", "warp instruction", "Loads from local memory.", "sum(core.local_loads)", ""},
    {"local_stores", "warp instruction", "Stores to local memory.", "sum(core.local_stores)", ""},
    {"global_loads", "warp instruction", "Loads from global memory.", "sum(core.global_loads)", ""},
    {"global_stores", "warp instruction", "Stores to global memory.", "sum(core.global_stores)", ""},
    {"const_loads", "warp instruction", "Loads from the constant bank.", "sum(core.constant_loads)", ""},
    {"l1d_accesses", "request", "Reads and writes of all L1s, of shaders and RT units.",
     "sum(l1.reads::*) + sum(l1.writes::*)", "Fig. 11"},
    {"l1d_miss_rate", "fraction",
     "Reads that fetched at least one sector. Reads of sectors on their way already (pending hits) are no "
     "misses, as in GPGPU-Sim.",
     "sum(l1.misses::*) / sum(l1.reads::*)", "Fig. 6, Fig. 11"},
    {"l1d_shader_miss_rate", "fraction",
     "Reads of shaders that fetched at least one sector; pending hits are no misses.",
     "sum(l1.misses::shader_*) / sum(l1.reads::shader_*)", "Fig. 11"},
    {"l2_accesses", "request", "Reads and writes of all L2 slices.", "sum(l2.reads::*) + sum(l2.writes::*)",
     ""},
    {"l2_miss_rate", "fraction", "Reads that fetched at least one sector.",
     "sum(l2.misses::*) / sum(l2.reads::*)", ""},
    {"dram_eff", "fraction", "Clocks with data of those in which a channel had a request.",
     "sum(dram.busy_clocks) / sum(dram.active_clocks)", "Fig. 12"},
    {"dram_util", "fraction", "Clocks with data of all.", "sum(dram.busy_clocks) / sum(dram.clocks)",
     "Fig. 12, Table 3"},
    {"row_locality", "fraction", "Requests whose row was open.", "sum(dram.row_hits) / sum(dram.picks)",
     "Table 3"},
    {"avg_mf_latency", "cycle", "From a read that did not hit in the L1 to its last sector.",
     "sum(l1.miss_cycles) / sum(l1.timed_misses)", "Fig. 15 (model input)"},
    {"avg_mrq_latency", "DRAM clock", "From the DRAM queue to the column command.",
     "sum(dram.queue_clocks) / sum(dram.requests)", ""},
};

constexpr Metric kRtUnit[] = {
    {"rt_insn", "lane instruction", "traceRay instructions of lanes: rays.", "sum(rt.rays)", ""},
    {"ins_rt%", "%", "Share of warp instructions: traces and what hit objects and ray queries do.",
     "100 * sum(core.instructions_by_class::rt) / sum(core.instructions)", "Fig. 8 (top)"},
    {"lat_rt%", "%",
     "Share of the cycles from issue to completion, summed over warp instructions: traces and what hit "
     "objects and ray queries do.",
     "100 * sum(core.latency_by_class::rt) / sum(core.latency_by_class::*)", "Fig. 8 (bottom)"},
    {"warp_latency", "cycle", "From a warp's acceptance by the RT unit to its return.",
     "sum(rt.warp_latency_sum) / sum(rt.warps)", ""},
    {"thread_latency", "cycle", "From a ray's acceptance to its stop.",
     "sum(rt.ray_cycles) / (sum(rt.rays) + sum(rt.resumed_rays))", ""},
    {"rt_efficiency", "fraction", "Rays in flight of the lanes of resident warps.",
     "sum(rt.ray_cycles) / sum(rt.lane_slots)", "Fig. 9 (top)"},
    {"rt_occupancy", "fraction", "Resident warps of the unit's warp slots, averaged over cycles with any.",
     "sum(rt.warp_cycles) / ((sum(rt.unit_cycles) - sum(rt.cycles::idle)) * config(rt.warps))",
     "Fig. 9 (top), Fig. 6"},
    {"rt_active_cycles", "cycle", "Cycles with a resident warp, mean over units.",
     "(sum(rt.unit_cycles) - sum(rt.cycles::idle)) / config(cores)", "Table 3"},
    {"rt_writes", "request", "Write requests of the RT units: results and tables of candidates.",
     "sum(rt.result_writes) + sum(rt.table_writes)", "Table 3"},
    {"rt_store_q_max", "request", "Longest store queue.", "", kNoStoreQueue},
    {"rt_store_cycles", "cycle", "Mean cycles of a store in the queue.", "", kNoStoreQueue},
    {"rt_op_intensity", "lane cycle/request", "Lane cycles in tests (intersection_stages) for each request.",
     "(sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) "
     "+ sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)) / sum(rt.requests)",
     ""},
    {"rt_perf", "lane cycle/cycle",
     "Lane cycles in tests a cycle with a resident warp: tests in flight in a unit.",
     "(sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) "
     "+ sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)) / (sum(rt.unit_cycles) - sum(rt.cycles::idle))",
     ""},
    {"cachelines", "request", "Read requests that the L1s took from the RT units.", "sum(rt.requests)", ""},
    {"intersection_stages", "lane cycle", "Tests, each times its latency; waiting for a pipe is left out.",
     "sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) + "
     "sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)",
     ""},
    {"box_tests", "test", "Ray-box tests, each child of a node counted.", "sum(rt.box_tests)", ""},
    {"tri_tests", "test", "Ray-triangle tests.", "sum(rt.triangle_tests)", ""},
    {"proc_tests", "test", "Procedural leaves visited: boxes whose intersection shader may run.",
     "sum(rt.procedural_leaves)", ""},
    {"transforms", "test", "Rays transformed to object space: instance leaves visited.",
     "sum(rt.instance_leaves)", ""},
    {"acc_structure", "read",
     "Reads of a structure's header, by ray; hardware-like configurations have none "
     "(rt.shortcuts.fetch_headers).",
     "sum(rt.headers)", ""},
    {"acc_internal", "request", "Reads of internal nodes.", "sum(l1.reads::rt_node)", "Fig. 13"},
    {"acc_instance_leaf", "request", "Reads of instance leaves.", "sum(l1.reads::rt_instance)", "Fig. 13"},
    {"acc_prim_leaf", "read",
     "Reads of descriptors of primitive leaves, by ray; hardware-like configurations have none "
     "(rt.shortcuts.fetch_descriptors).",
     "sum(rt.descriptors)", ""},
    {"acc_quad_leaf", "request", "Reads of triangle leaves.", "sum(l1.reads::rt_triangle)", "Fig. 13"},
    {"acc_proc_leaf", "request", "Reads of procedural leaves.", "sum(l1.reads::rt_procedural)", "Fig. 13"},
    {"acc_table", "request", "Reads and writes of tables of candidates; none with rt.any_hit = immediate.",
     "sum(l1.reads::rt_table) + sum(l1.writes::rt_table)", "Fig. 13"},
    {"rt_read_hits", "request", "Reads of RT units that hit in the L1.", "sum(l1.hits::rt_*)",
     "Fig. 11, Table 3"},
    {"rt_cold_misses", "request", "Misses of RT units on lines that their L1 had never held.",
     "sum(l1.cold_misses::rt_*)", "Fig. 11"},
    {"rt_miss_rate", "fraction",
     "Reads of RT units that fetched at least one sector; pending hits are no misses.",
     "sum(l1.misses::rt_*) / sum(l1.reads::rt_*)", "Fig. 11"},
};

constexpr Metric kScene[] = {
    {"triangles", "triangle", "Triangles in bottom-level structures.", "run(structures.triangles)",
     "Fig. 7, Table 1"},
    {"procedurals", "primitive", "Procedural primitives.", "run(structures.procedurals)", "Table 1"},
    {"blas_count", "structure", "Bottom-level structures.", "run(structures.bottom_levels)", "Fig. 7"},
    {"instances", "instance", "Instances of the top level.", "run(structures.instances)", "Fig. 7"},
    {"bvh_bytes", "byte", "All structures.", "run(structures.bytes)", "Table 1"},
    {"tlas_depth", "level", "Levels of the top level's deepest path.", "run(structures.top_depth)", "Fig. 7"},
    {"bvh_depth", "level", "Levels of the deepest path, top level and deepest bottom level together.",
     "run(structures.top_depth) + run(structures.bottom_depth)", "Fig. 7, Table 3"},
    {"%internal", "%", "Internal nodes of the nodes visited.", "100 * sum(rt.internal_nodes) / sum(rt.nodes)",
     "Fig. 13, Table 3"},
    {"%tlas_leaf", "%", "Instance leaves of the nodes visited.",
     "100 * sum(rt.instance_leaves) / sum(rt.nodes)", "Fig. 13, Table 3"},
    {"%leaf", "%", "Triangle and procedural leaves of the nodes visited.",
     "100 * (sum(rt.triangle_leaves) + sum(rt.procedural_leaves)) / sum(rt.nodes)", "Fig. 13"},
    {"avg_nodes_per_ray", "node/ray", "Nodes and leaves that a ray visits, mean.",
     "sum(rt.nodes) / sum(rt.rays)", "Fig. 10"},
    {"max_nodes_per_ray", "node", "Most that one ray visited.", "max(rt.max_ray_nodes)", ""},
    {"traversal_ratio", "ratio", "Mean nodes a ray for each level of the structure.",
     "sum(rt.nodes) / sum(rt.rays) / (run(structures.top_depth) + run(structures.bottom_depth))", "Fig. 10"},
    {"hits", "ray", "Rays whose closest-hit shader ran.", "sum(core.closest_hit.invocations)", ""},
    {"anyhits", "candidate", "Candidates that an any-hit shader judged: the same as n_anyhit.",
     "sum(core.any_hit.invocations)", ""},
    {"rays_closest", "ray", "Rays that look for the closest hit.", "sum(rt.rays) - sum(rt.first_hit_rays)",
     ""},
    {"rays_any", "ray", "Rays that may end at any hit: TerminateOnFirstHit.", "sum(rt.first_hit_rays)", ""},
    {"rays_total", "ray", "All rays.", "sum(rt.rays)", ""},
    {"n_raygen", "invocation", "Ray-generation shaders begun, by lane.", "sum(core.raygen.invocations)", ""},
    {"n_chit", "invocation", "Closest-hit shaders begun.", "sum(core.closest_hit.invocations)", ""},
    {"n_miss", "invocation", "Miss shaders begun.", "sum(core.miss.invocations)", ""},
    {"n_anyhit", "invocation", "Any-hit shaders begun.", "sum(core.any_hit.invocations)", ""},
    {"n_intersection", "invocation", "Intersection shaders begun.", "sum(core.intersection.invocations)", ""},
};
static_assert(std::size(kGpu) == 35 && std::size(kRtUnit) == 29 && std::size(kScene) == 23);

constexpr MetricGroup kGroups[] = {{"GPU", kGpu}, {"RT unit", kRtUnit}, {"Scene and shaders", kScene}};

}  // namespace

std::span<const MetricGroup> metric_groups() {
  return kGroups;
}

}  // namespace glint::report
