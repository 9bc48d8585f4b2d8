// Holds the table of Vulkan-Sim's names, and prints it.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/vulkan_sim.h"

#include <fmt/format.h>

#include "report/metrics/formula.h"

namespace glint::report {
namespace {

// These are names and meanings as Vulkan-Sim 2.0 (GPGPU-Sim 4) prints them at the end of a launch.
constexpr PeerStat kStats[] = {
    {"gpu_sim_cycle", "sum(gpu.cycles)", ""},
    {"gpu_sim_insn", "sum(core.lane_instructions)", "It counts Glint's own instructions, not NVIDIA's PTX."},
    {"gpu_ipc", "sum(core.lane_instructions) / sum(gpu.cycles)", "The unit is lane instructions per cycle."},
    {"gpu_tot_sim_cycle", "sum(gpu.cycles)", "It is equal to gpu_sim_cycle, because there is one launch."},
    {"gpu_tot_sim_insn", "sum(core.lane_instructions)", ""},
    {"gpu_tot_ipc", "sum(core.lane_instructions) / sum(gpu.cycles)", ""},
    {"gpu_tot_issued_cta", "sum(core.blocks)", ""},
    {"gpu_occupancy", "100 * sum(core.resident_cycles) / sum(core.slot_cycles)",
     "It is a percentage over all cycles; Vulkan-Sim's is over the cycles of cores with a warp."},
    {"gpu_tot_occupancy", "100 * sum(core.resident_cycles) / sum(core.slot_cycles)",
     "It is equal to gpu_occupancy."},
    {"gpu_total_sim_rate", "sum(core.lane_instructions) / run(wall_seconds)",
     "The unit is lane instructions per second of the host."},
    {"gpu_stall_dramfull", "sum(l2.cycles::queue_full)", "It counts cycles of slices."},
    {"gpu_stall_icnt2sh", "",
     "Glint counts how long replies wait (l2.reply_wait), not cycles with any waiting."},
    {"partiton_level_parallism", "(sum(l2.reads::*) + sum(l2.writes::*)) / sum(gpu.cycles)", ""},
    {"L2_BW", "sum(l2.reply_bytes) / sum(gpu.cycles) * config(clock_mhz) / 1000",
     "The unit is GB/s. Headers are included."},
    {"gpgpu_n_tot_thrd_icount", "sum(core.lane_instructions)", ""},
    {"gpgpu_n_tot_w_icount", "sum(core.instructions)", ""},
    {"gpgpu_n_stall_shd_mem", "sum(core.issue_slots::lsu_throttle)", "It counts cycles of schedulers."},
    {"gpgpu_n_mem_read_local", "sum(l2.reads::shader_local)", "It counts requests that left the L1s."},
    {"gpgpu_n_mem_write_local", "sum(l2.writes::shader_local)", ""},
    {"gpgpu_n_mem_read_global",
     "sum(l2.reads::shader_global) + sum(l2.reads::shader_binding) + sum(l2.reads::rt_*)",
     "RT units are included, as in Vulkan-Sim."},
    {"gpgpu_n_mem_write_global",
     "sum(l2.writes::shader_global) + sum(l2.writes::shader_surface) + sum(l2.writes::rt_*)", ""},
    {"gpgpu_n_mem_texture", "sum(l2.reads::shader_texture) + sum(l2.reads::shader_surface)", ""},
    {"gpgpu_n_mem_const", "", "Constant loads always hit."},
    {"gpgpu_n_local_load_insn", "sum(core.local_loads)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_local_store_insn", "sum(core.local_stores)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_global_load_insn", "sum(core.global_loads)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_global_store_insn", "sum(core.global_stores)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_shmem_insn", "sum(core.shared_loads) + sum(core.shared_stores)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_tex_insn", "sum(core.texture_fetches)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_const_mem_insn", "sum(core.constant_loads)",
     "It counts warp instructions, and Vulkan-Sim counts lanes."},
    {"gpgpu_n_rt_insn", "sum(rt.rays)", "It counts lanes as in Vulkan-Sim, which are rays."},
    {"gpgpu_n_rt_access_insn", "sum(rt.fetches)", "It counts distinct nodes that are asked for."},
    {"gpgpu_n_shmem_bkconflict",
     "sum(core.shared_passes) - sum(core.shared_loads) - sum(core.shared_stores) - sum(core.shared_atomics)",
     "It counts passes beyond the first."},
    {"gpu_reg_bank_conflict_stalls", "", "Glint has no register banks."},
    {"L1D_total_cache_accesses", "sum(l1.reads::*) + sum(l1.writes::*)", ""},
    {"L1D_total_cache_misses", "sum(l1.misses::*) + sum(l1.writes::*) - sum(l1.write_hits::*)", ""},
    {"L1D_total_cache_miss_rate",
     "(sum(l1.misses::*) + sum(l1.writes::*) - sum(l1.write_hits::*)) / (sum(l1.reads::*) + "
     "sum(l1.writes::*))",
     ""},
    {"L1D_total_cache_pending_hits", "sum(l1.pending_hits::*)", ""},
    {"L1D_total_cache_reservation_fails", "sum(l1.refusals::*)", ""},
    {"rt_read_cold_miss", "sum(l1.cold_misses::rt_*)", "It counts misses of the L1s (RT_L1D)."},
    {"rt_read_other_miss", "sum(l1.misses::rt_*) - sum(l1.cold_misses::rt_*)", ""},
    {"rt_stats[READ][HIT]", "sum(l1.hits::rt_*)", ""},
    {"rt_stats[READ][HIT_RESERVED]", "sum(l1.pending_hits::rt_*)", ""},
    {"rt_stats[READ][MISS]", "sum(l1.misses::rt_*)", "Sector misses are included."},
    {"rt_read_miss_rate", "sum(l1.misses::rt_*) / sum(l1.reads::rt_*)", ""},
    {"rt_stats[WRITE][HIT]", "sum(l1.write_hits::rt_*)", ""},
    {"rt_overall_miss_rate",
     "(sum(l1.misses::rt_*) + sum(l1.writes::rt_*) - sum(l1.write_hits::rt_*)) / (sum(l1.reads::rt_*) + "
     "sum(l1.writes::rt_*))",
     ""},
    {"L2_total_cache_accesses", "sum(l2.reads::*) + sum(l2.writes::*)", ""},
    {"L2_total_cache_misses", "sum(l2.misses::*) + sum(l2.writes::*) - sum(l2.write_hits::*)", ""},
    {"L2_total_cache_miss_rate",
     "(sum(l2.misses::*) + sum(l2.writes::*) - sum(l2.write_hits::*)) / (sum(l2.reads::*) + "
     "sum(l2.writes::*))",
     ""},
    {"L2_total_cache_pending_hits", "sum(l2.pending_hits::*)", ""},
    {"L2_total_cache_reservation_fails",
     "sum(l2.cycles::mshr_full) + sum(l2.cycles::merge_limit) + sum(l2.cycles::queue_full)",
     "It counts cycles that the head of a queue waited."},
    {"n_act", "sum(dram.activates)", "It is the sum of all channels."},
    {"n_pre", "sum(dram.precharges)", ""},
    {"n_req", "sum(dram.requests)", ""},
    {"n_rd", "sum(dram.reads)", ""},
    {"n_write", "sum(dram.writes)", ""},
    {"bw_util", "sum(dram.busy_clocks) / sum(dram.clocks)", "It is the mean of the channels."},
    {"dram_eff", "sum(dram.busy_clocks) / sum(dram.active_clocks)", ""},
    {"Row_Buffer_Locality", "sum(dram.row_hits) / sum(dram.picks)", ""},
    {"Bank_Level_Parallism", "sum(dram.bank_clocks) / sum(dram.any_bank_clocks)", ""},
    {"averagemflatency", "sum(l1.miss_cycles) / sum(l1.timed_misses)",
     "It is in core cycles, and covers reads that did not hit."},
    {"avg_mrq_latency", "sum(dram.queue_clocks) / sum(dram.requests)", "It is in DRAM clocks."},
    {"avg_icnt2mem_latency", "sum(l1.miss_stages::request) / sum(l1.timed_misses)", "It is in core cycles."},
    {"avg_icnt2sh_latency", "sum(l1.miss_stages::reply) / sum(l1.timed_misses)", "It is in core cycles."},
    {"rt_avg_warp_latency", "sum(rt.warp_latency_sum) / sum(rt.warps)", ""},
    {"rt_avg_thread_latency", "sum(rt.ray_cycles) / (sum(rt.rays) + sum(rt.resumed_rays))", ""},
    {"rt_avg_efficiency", "sum(rt.ray_cycles) / sum(rt.lane_slots)", ""},
    {"rt_avg_warp_occupancy",
     "sum(rt.warp_cycles) / ((sum(rt.unit_cycles) - sum(rt.cycles::idle)) * config(rt.warps))", ""},
    {"rt_total_cacheline_fetched", "sum(rt.requests)",
     "It is the sum of all units. A request has up to config(rt.request_bytes) bytes."},
    {"rt_total_intersection_stages",
     "sum(rt.internal_nodes) * config(rt.box.latency) + sum(rt.procedural_leaves) * config(rt.box.latency) + "
     "sum(rt.triangle_tests) * config(rt.triangle.latency) + sum(rt.instance_leaves) * "
     "config(rt.transform.latency)",
     "It counts lane cycles in tests of all units."},
    {"rt_writes", "sum(rt.result_writes) + sum(rt.table_writes) + sum(rt.hit_writes)", ""},
    {"rt_max_mem_store_q", "", "Glint's RT unit has no store queue."},
    {"rt_avg_mem_store_cycles", "", "Glint's RT unit has no store queue."},
    {"rt_cycles", "(sum(rt.unit_cycles) - sum(rt.cycles::idle)) / sum(rt.unit_cycles)",
     "It is the fraction of cycles with a resident warp."},
    {"rt_total_cycles", "(sum(rt.unit_cycles) - sum(rt.cycles::idle)) / config(cores)",
     "It is the mean of the units."},
    {"rt_total_cycles_sum", "sum(rt.unit_cycles) - sum(rt.cycles::idle)", ""},
    {"gpgpu_n_rt_mem[BVH_STRUCTURE]", "", "Glint's traversal reads no header of a structure."},
    {"gpgpu_n_rt_mem[BVH_INTERNAL_NODE]", "sum(l1.reads::rt_node)",
     "A request has up to config(rt.request_bytes) bytes; Vulkan-Sim's have 32."},
    {"gpgpu_n_rt_mem[BVH_INSTANCE_LEAF]", "sum(l1.reads::rt_instance)", ""},
    {"gpgpu_n_rt_mem[BVH_PRIMITIVE_LEAF_DESCRIPTOR]", "", "Glint's leaves have no descriptor."},
    {"gpgpu_n_rt_mem[BVH_QUAD_LEAF]", "sum(l1.reads::rt_triangle)", ""},
    {"gpgpu_n_rt_mem[BVH_QUAD_LEAF_HIT]", "sum(rt.result_writes)",
     "There are none with rt.result_store = false."},
    {"gpgpu_n_rt_mem[BVH_PROCEDURAL_LEAF]", "sum(l1.reads::rt_procedural)", ""},
    {"gpgpu_n_rt_mem[Intersection_Table_Load]", "sum(l1.reads::rt_table)", ""},
    {"rt_num_hits", "sum(core.closest_hit.invocations)", "It counts rays whose closest-hit shader ran."},
    {"rt_num_any_hits", "sum(core.any_hit.invocations)",
     "It counts candidates that an any-hit shader judged."},
    {"rt_n_anyhit_rays", "sum(rt.first_hit_rays)",
     "It counts rays with TerminateOnFirstHit, as in Vulkan-Sim."},
    {"rt_n_closesthit_rays", "sum(rt.rays) - sum(rt.first_hit_rays)", ""},
    {"rt_n_total_rays", "sum(rt.rays)", ""},
    {"rt_max_tree_depth", "run(structures.top_depth) + run(structures.bottom_depth)", ""},
    {"rt_max_nodes_per_ray", "max(rt.max_ray_nodes)", ""},
    {"rt_tot_nodes_per_ray", "sum(rt.nodes)", ""},
    {"rt_avg_nodes_per_ray", "sum(rt.nodes) / sum(rt.rays)", ""},
};

}  // namespace

std::span<const PeerStat> vulkan_sim_stats() {
  return kStats;
}

std::string vulkan_sim_text(const RunRecord& run) {
  std::string out, missing;
  for (const PeerStat& stat : kStats) {
    const std::optional<double> value =
        stat.formula.empty() ? std::nullopt : evaluate(std::string(stat.formula), run);
    if (value)
      out += fmt::format("{} = {}\n", stat.name, *value);
    else
      missing += fmt::format("# {}: {}\n", stat.name,
                             stat.formula.empty() ? std::string(stat.note) : why_absent(run));
  }
  return out + missing;
}

std::string vulkan_sim_markdown() {
  std::string out = "| Vulkan-Sim | formula | note |\n|---|---|---|\n";
  for (const PeerStat& stat : kStats)
    out += fmt::format("| `{}` | {} | {} |\n", stat.name,
                       stat.formula.empty() ? "*none*" : fmt::format("`{}`", stat.formula), stat.note);
  return out;
}

}  // namespace glint::report
