// Lists every metric once: name, unit, meaning, formula, and where the paper shows it.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/metrics.h"

namespace glint::report {
namespace {

constexpr std::string_view kNoStoreQueue =
    "Glint's RT unit has no store queue: results go to registers, and table writes are sent at once.";

constexpr Metric kGpu[] = {
    {"cycles", "cycle", "Core cycles from the launch to the end of the last core.", "sum(gpu.cycles)",
     "Fig. 7 (PT)"},
    {"insn", "lane instruction", "Number of instructions that lanes executed.", "sum(core.lane_instructions)",
     ""},
    {"thread_ipc", "lane instruction/cycle",
     "Lane instructions per cycle of the whole GPU, as in GPGPU-Sim's gpu_tot_ipc. The value is up to 32 "
     "times IPC, which counts warp instructions.",
     "sum(core.lane_instructions) / sum(gpu.cycles)", "Fig. 14, Fig. 6"},
    {"occupancy", "fraction", "Fraction of the warp slots that hold a resident warp.",
     "sum(core.resident_cycles) / sum(core.slot_cycles)", ""},
    {"simt_efficiency", "fraction", "Fraction of the 32 lanes that execute, averaged over warp instructions.",
     "sum(core.lane_instructions) / (32 * sum(core.instructions))", "Fig. 9 (bottom)"},
    {"sim_rate", "lane instruction/s",
     "Lane instructions that the host simulates per second. This is the only metric that differs from run to "
     "run.",
     "sum(core.lane_instructions) / run(wall_seconds)", ""},
    {"stall_dramfull", "cycle",
     "Cycles in which an L2 slice could not serve a request because the DRAM queue was full, summed over "
     "slices.",
     "sum(l2.cycles::queue_full)", ""},
    {"stall_icnt2sh", "cycle",
     "Cycles that replies waited for the network's port at their L2 slice, summed over replies. Vulkan-Sim "
     "counts cycles in which any reply waits.",
     "sum(l2.reply_wait)", ""},
    {"partition_parallelism", "request/cycle", "Requests that all L2 slices together served per cycle.",
     "(sum(l2.reads::*) + sum(l2.writes::*)) / sum(gpu.cycles)", ""},
    {"l2_bw", "GB/s", "Bandwidth of the replies of the L2, including their headers.",
     "sum(l2.reply_bytes) / sum(gpu.cycles) * config(clock_mhz) / 1000", ""},
    {"w_icount", "warp instruction", "Number of warp instructions issued.", "sum(core.instructions)",
     "Fig. 8 (top)"},
    {"thrd_icount", "lane instruction",
     "Number of instructions that lanes executed. It is equal to insn, because Vulkan-Sim has two names for "
     "this number.",
     "sum(core.lane_instructions)", ""},
    {"shd_mem_stalls", "cycle",
     "Scheduler cycles in which an instruction was ready but the memory queue was full.",
     "sum(core.issue_slots::lsu_throttle)", ""},
    {"ins_alu%", "%",
     "Percentage of warp instructions that compute with integers, floating-point numbers or predicates, or "
     "move values.",
     "100 * sum(core.instructions_by_class::alu) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_sfu%", "%", "Percentage of warp instructions that are transcendental functions or divisions.",
     "100 * sum(core.instructions_by_class::sfu) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_mem%", "%", "Percentage of warp instructions that are loads, stores or atomics.",
     "100 * sum(core.instructions_by_class::mem) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_tex%", "%", "Percentage of warp instructions that access textures or images.",
     "100 * sum(core.instructions_by_class::tex) / sum(core.instructions)", "Fig. 8 (top)"},
    {"ins_ctrl%", "%", "Percentage of warp instructions that are branches, calls or barriers.",
     "100 * sum(core.instructions_by_class::ctrl) / sum(core.instructions)", "Fig. 8 (top)"},
    {"lat_alu%", "%",
     "Percentage of the cycles from issue to completion, summed over warp instructions, that belongs to "
     "computations with integers, floating-point numbers and predicates, and to moves.",
     "100 * sum(core.latency_by_class::alu) / sum(core.latency_by_class::*)", "Fig. 8 (bottom)"},
    {"lat_mem%", "%",
     "Percentage of the cycles from issue to completion, summed over warp instructions, that belongs to "
     "loads, stores and atomics.",
     "100 * sum(core.latency_by_class::mem) / sum(core.latency_by_class::*)", "Fig. 8 (bottom)"},
    {"local_loads", "warp instruction", "Number of warp instructions that load from local memory.",
     "sum(core.local_loads)", ""},
    {"local_stores", "warp instruction", "Number of warp instructions that store to local memory.",
     "sum(core.local_stores)", ""},
    {"global_loads", "warp instruction", "Number of warp instructions that load from global memory.",
     "sum(core.global_loads)", ""},
    {"global_stores", "warp instruction", "Number of warp instructions that store to global memory.",
     "sum(core.global_stores)", ""},
    {"const_loads", "warp instruction", "Number of warp instructions that load from the constant bank.",
     "sum(core.constant_loads)", ""},
    {"l1d_accesses", "request", "Number of reads and writes that all L1s took from shaders and RT units.",
     "sum(l1.reads::*) + sum(l1.writes::*)", "Fig. 11"},
    {"l1d_miss_rate", "fraction",
     "Fraction of L1 reads that fetched at least one sector. Reads of sectors that are already on their way "
     "(pending hits) are not misses, as in GPGPU-Sim.",
     "sum(l1.misses::*) / sum(l1.reads::*)", "Fig. 6, Fig. 11"},
    {"l1d_shader_miss_rate", "fraction",
     "Fraction of L1 reads of shaders that fetched at least one sector. Pending hits are not misses.",
     "sum(l1.misses::shader_*) / sum(l1.reads::shader_*)", "Fig. 11"},
    {"l2_accesses", "request", "Number of reads and writes that all L2 slices took.",
     "sum(l2.reads::*) + sum(l2.writes::*)", ""},
    {"l2_miss_rate", "fraction", "Fraction of L2 reads that fetched at least one sector.",
     "sum(l2.misses::*) / sum(l2.reads::*)", ""},
    {"dram_eff", "fraction", "Fraction of the clocks with a request in a channel that transferred data.",
     "sum(dram.busy_clocks) / sum(dram.active_clocks)", "Fig. 12"},
    {"dram_util", "fraction", "Fraction of all clocks that transferred data.",
     "sum(dram.busy_clocks) / sum(dram.clocks)", "Fig. 12, Table 3"},
    {"row_locality", "fraction", "Fraction of requests whose row was open.",
     "sum(dram.row_hits) / sum(dram.picks)", "Table 3"},
    {"avg_mf_latency", "cycle", "Mean cycles from a read that did not hit in the L1 to its last sector.",
     "sum(l1.miss_cycles) / sum(l1.timed_misses)", "Fig. 15 (model input)"},
    {"avg_mrq_latency", "DRAM clock",
     "Mean DRAM clocks from a request's entry into the DRAM queue to its column command.",
     "sum(dram.queue_clocks) / sum(dram.requests)", ""},
};

constexpr Metric kRtUnit[] = {
    {"rt_insn", "lane instruction", "Number of traceRay instructions of lanes, which is the number of rays.",
     "sum(rt.rays)", ""},
    {"ins_rt%", "%",
     "Percentage of warp instructions that are traces or operations of hit objects and ray queries.",
     "100 * sum(core.instructions_by_class::rt) / sum(core.instructions)", "Fig. 8 (top)"},
    {"lat_rt%", "%",
     "Percentage of the cycles from issue to completion, summed over warp instructions, that belongs to "
     "traces and operations of hit objects and ray queries.",
     "100 * sum(core.latency_by_class::rt) / sum(core.latency_by_class::*)", "Fig. 8 (bottom)"},
    {"warp_latency", "cycle", "Mean cycles from a warp's acceptance by the RT unit to its return.",
     "sum(rt.warp_latency_sum) / sum(rt.warps)", ""},
    {"thread_latency", "cycle", "Mean cycles from a ray's acceptance to its stop.",
     "sum(rt.ray_cycles) / (sum(rt.rays) + sum(rt.resumed_rays))", ""},
    {"rt_efficiency", "fraction", "Fraction of the lanes of resident warps with a ray in flight.",
     "sum(rt.ray_cycles) / sum(rt.lane_slots)", "Fig. 9 (top)"},
    {"rt_occupancy", "fraction",
     "Fraction of the unit's warp slots that hold a resident warp, averaged over cycles with at least one.",
     "sum(rt.warp_cycles) / ((sum(rt.unit_cycles) - sum(rt.cycles::idle)) * config(rt.warps))",
     "Fig. 9 (top), Fig. 6"},
    {"rt_active_cycles", "cycle", "Cycles with a resident warp, averaged over units.",
     "(sum(rt.unit_cycles) - sum(rt.cycles::idle)) / config(cores)", "Table 3"},
    {"rt_writes", "request",
     "Number of write requests of the RT units, for results, tables of candidates and stored hits.",
     "sum(rt.result_writes) + sum(rt.table_writes) + sum(rt.hit_writes)", "Table 3"},
    {"rt_store_q_max", "request", "Largest number of requests in the store queue.", "", kNoStoreQueue},
    {"rt_store_cycles", "cycle", "Mean cycles that a store is in the store queue.", "", kNoStoreQueue},
    {"rt_op_intensity", "lane cycle/request", "Lane cycles in tests (intersection_stages) per read request.",
     "(sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) "
     "+ sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)) / sum(rt.requests)",
     ""},
    {"rt_perf", "lane cycle/cycle",
     "Lane cycles in tests per cycle with a resident warp, which is the mean number of tests in flight in a "
     "unit.",
     "(sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) "
     "+ sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)) / (sum(rt.unit_cycles) - sum(rt.cycles::idle))",
     ""},
    {"cachelines", "request", "Number of read requests that the L1s took from the RT units.",
     "sum(rt.requests)", ""},
    {"intersection_stages", "lane cycle",
     "Lane cycles in tests: each test counts with its latency, without waiting for a pipe.",
     "sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) + "
     "sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)",
     ""},
    {"box_tests", "test", "Number of ray-box tests. Each child of a node counts.", "sum(rt.box_tests)", ""},
    {"tri_tests", "test", "Number of ray-triangle tests.", "sum(rt.triangle_tests)", ""},
    {"proc_tests", "test",
     "Number of procedural leaves visited, which are boxes whose intersection shader may run.",
     "sum(rt.procedural_leaves)", ""},
    {"transforms", "test",
     "Number of transformations of rays to object space, which is the number of instance leaves visited.",
     "sum(rt.instance_leaves)", ""},
    {"acc_structure", "read",
     "Number of reads of a structure's header, by ray. Configurations that are like hardware have none "
     "(rt.shortcuts.fetch_headers).",
     "sum(rt.headers)", ""},
    {"acc_internal", "request", "Number of reads of internal nodes.", "sum(l1.reads::rt_node)", "Fig. 13"},
    {"acc_instance_leaf", "request", "Number of reads of instance leaves.", "sum(l1.reads::rt_instance)",
     "Fig. 13"},
    {"acc_prim_leaf", "read",
     "Number of reads of descriptors of primitive leaves, by ray. Configurations that are like hardware have "
     "none (rt.shortcuts.fetch_descriptors).",
     "sum(rt.descriptors)", ""},
    {"acc_quad_leaf", "request", "Number of reads of triangle leaves.", "sum(l1.reads::rt_triangle)",
     "Fig. 13"},
    {"acc_proc_leaf", "request", "Number of reads of procedural leaves.", "sum(l1.reads::rt_procedural)",
     "Fig. 13"},
    {"acc_table", "request",
     "Number of reads and writes of tables of candidates. There are none with rt.any_hit = immediate.",
     "sum(l1.reads::rt_table) + sum(l1.writes::rt_table)", "Fig. 13"},
    {"rt_read_hits", "request", "Number of reads of RT units that hit in the L1.", "sum(l1.hits::rt_*)",
     "Fig. 11, Table 3"},
    {"rt_cold_misses", "request", "Number of misses of RT units on lines that their L1 had never held.",
     "sum(l1.cold_misses::rt_*)", "Fig. 11"},
    {"rt_miss_rate", "fraction",
     "Fraction of L1 reads of RT units that fetched at least one sector. Pending hits are not misses.",
     "sum(l1.misses::rt_*) / sum(l1.reads::rt_*)", "Fig. 11"},
};

constexpr Metric kScene[] = {
    {"triangles", "triangle", "Number of triangles in bottom-level structures.", "run(structures.triangles)",
     "Fig. 7, Table 1"},
    {"procedurals", "primitive", "Number of procedural primitives.", "run(structures.procedurals)",
     "Table 1"},
    {"blas_count", "structure", "Number of bottom-level structures.", "run(structures.bottom_levels)",
     "Fig. 7"},
    {"instances", "instance", "Number of instances of the top level.", "run(structures.instances)", "Fig. 7"},
    {"bvh_bytes", "byte", "Size of all structures.", "run(structures.bytes)", "Table 1"},
    {"tlas_depth", "level", "Number of levels of the top level's deepest path.", "run(structures.top_depth)",
     "Fig. 7"},
    {"bvh_depth", "level",
     "Number of levels of the deepest path through the top level and the deepest bottom level together.",
     "run(structures.top_depth) + run(structures.bottom_depth)", "Fig. 7, Table 3"},
    {"%internal", "%", "Percentage of the visited nodes that are internal nodes.",
     "100 * sum(rt.internal_nodes) / sum(rt.nodes)", "Fig. 13, Table 3"},
    {"%tlas_leaf", "%", "Percentage of the visited nodes that are instance leaves.",
     "100 * sum(rt.instance_leaves) / sum(rt.nodes)", "Fig. 13, Table 3"},
    {"%leaf", "%", "Percentage of the visited nodes that are triangle leaves or procedural leaves.",
     "100 * (sum(rt.triangle_leaves) + sum(rt.procedural_leaves)) / sum(rt.nodes)", "Fig. 13"},
    {"avg_nodes_per_ray", "node/ray", "Mean number of nodes and leaves that a ray visits.",
     "sum(rt.nodes) / sum(rt.rays)", "Fig. 10"},
    {"max_nodes_per_ray", "node", "Largest number of nodes and leaves that one ray visited.",
     "max(rt.max_ray_nodes)", ""},
    {"traversal_ratio", "ratio",
     "Mean number of nodes that a ray visits, divided by the number of levels of the structure.",
     "sum(rt.nodes) / sum(rt.rays) / (run(structures.top_depth) + run(structures.bottom_depth))", "Fig. 10"},
    {"hits", "ray", "Number of rays whose closest-hit shader ran.", "sum(core.closest_hit.invocations)", ""},
    {"anyhits", "candidate",
     "Number of candidates that an any-hit shader judged, which is equal to n_anyhit.",
     "sum(core.any_hit.invocations)", ""},
    {"rays_closest", "ray", "Number of rays that look for the closest hit.",
     "sum(rt.rays) - sum(rt.first_hit_rays)", ""},
    {"rays_any", "ray", "Number of rays that may end at any hit (TerminateOnFirstHit).",
     "sum(rt.first_hit_rays)", ""},
    {"rays_total", "ray", "Number of all rays.", "sum(rt.rays)", ""},
    {"n_raygen", "invocation", "Number of ray-generation shaders begun. Each lane counts.",
     "sum(core.raygen.invocations)", ""},
    {"n_chit", "invocation", "Number of closest-hit shaders begun.", "sum(core.closest_hit.invocations)", ""},
    {"n_miss", "invocation", "Number of miss shaders begun.", "sum(core.miss.invocations)", ""},
    {"n_anyhit", "invocation", "Number of any-hit shaders begun.", "sum(core.any_hit.invocations)", ""},
    {"n_intersection", "invocation", "Number of intersection shaders begun.",
     "sum(core.intersection.invocations)", ""},
};
static_assert(std::size(kGpu) == 35 && std::size(kRtUnit) == 29 && std::size(kScene) == 23);

constexpr MetricGroup kGroups[] = {{"GPU", kGpu}, {"RT unit", kRtUnit}, {"Scene and shaders", kScene}};

}  // namespace

std::span<const MetricGroup> metric_groups() {
  return kGroups;
}

}  // namespace glint::report
