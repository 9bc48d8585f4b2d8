// Picks the summary's numbers out of a result and its statistics.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/summary.h"

#include <fmt/format.h>
#include <utility>

#include "isa/warp.h"
#include "memsys/peak.h"
#include "report/files/stat_rows.h"
#include "report/terminal/table.h"

namespace glint::app {
namespace {

// The names are in the order of isa::Class.
constexpr const char* kClassTitles[] = {"ALU", "SFU", "Mem", "Tex", "Ctrl", "RT"};
static_assert(std::size(kClassTitles) == size_t(isa::Class::Count));

// Sums statistics over all instances.
class Sums {
 public:
  explicit Sums(const stats::Group& root) : root_(root) {}
  uint64_t count(const std::string& pattern) const {
    return uint64_t(report::stat_sum(root_, pattern).value_or(0.0));
  }
  std::optional<double> ratio(const std::string& above, const std::string& below) const {
    const std::optional<double> a = report::stat_sum(root_, above), b = report::stat_sum(root_, below);
    if (!a || !b || *b == 0) return std::nullopt;
    return *a / *b;
  }
  report::HitRate hits(const std::string& cache, const std::string& traffic) const {
    return {count(cache + ".hits::" + traffic), count(cache + ".reads::" + traffic)};
  }

 private:
  const stats::Group& root_;
};

report::TimingSummary timing_of(const pipeline::RenderJob& job, const pipeline::RenderResult& result) {
  const Sums sums(result.statistics());
  const std::string l1 = "gpu.memory.core[*].l1", dram = "gpu.memory.partition[*].dram",
                    rt = "gpu.rt_unit[*].rt";
  report::TimingSummary out;
  out.cycles = result.cycles;
  out.clock_mhz = job.gpu.clock_mhz;
  out.resident_warps = result.residency.warps;
  out.warp_slots = job.gpu.core.warps;
  out.residency_limit = name_of(result.residency.limit);
  out.l1_rt = sums.hits(l1, "rt_*");
  out.l1_shader = sums.hits(l1, "shader_*");
  out.memory_peaks = mem::peak(job.gpu.memory, job.gpu.cores, job.gpu.clock_mhz).to_string();
  const report::HitRate one = sums.hits("gpu.memory.partition[*].l2", "*"),
                        several = sums.hits("gpu.memory.partition[*].l2[*]", "*");
  out.l2 = {one.hits + several.hits, one.accesses + several.accesses};
  out.dram_utilisation = sums.ratio(dram + ".busy_clocks", dram + ".clocks");
  out.dram_efficiency = sums.ratio(dram + ".busy_clocks", dram + ".active_clocks");
  if (const double busy = double(sums.count(rt + ".unit_cycles") - sums.count(rt + ".cycles::idle"));
      busy > 0)
    out.rt_occupancy = double(sums.count(rt + ".warp_cycles")) / (busy * job.gpu.rt.warps);
  out.rt_efficiency = sums.ratio(rt + ".ray_cycles", rt + ".lane_slots");
  return out;
}

}  // namespace

report::Summary summarise(const pipeline::RenderJob& job, const pipeline::RenderResult& result) {
  report::Summary out;
  out.note = job.scene.note;
  out.warp_instructions = result.warp_instructions;
  if (result.warp_instructions > 0)
    out.simt_efficiency = double(result.lane_instructions) / (double(result.warp_instructions) * kLanes);
  for (size_t c = 0; c < size_t(isa::Class::Count); ++c)
    out.mix.push_back({kClassTitles[c], result.by_class[c].instructions, result.by_class[c].latency});
  out.rays = result.rays.rays;
  if (result.rays.rays > 0) out.nodes_per_ray = double(result.rays.nodes) / double(result.rays.rays);
  out.bvh_depth = result.structures.top_depth + result.structures.bottom_depth;
  out.wall_seconds = result.wall_seconds;
  if (job.timing) out.timing = timing_of(job, result);
  return out;
}

void add_sample(const report::SampleInfo& sample, std::span<const pipeline::Estimate> estimates,
                report::Summary& summary) {
  const std::string timed = report::with_thousands(sample.timed), all = report::with_thousands(sample.all);
  report::SampleSummary out;
  out.about =
      sample.of == report::SampleInfo::Of::Launches
          ? fmt::format("seed {}: {} of {} launches were timed, of {} clusters", sample.seed, timed, all,
                        sample.clusters)
          : fmt::format("a sample of {:g} %, seed {}: {} of {} blocks were timed on 1/{} of the machine",
                        100 * sample.share, sample.seed, timed, all, sample.scale);
  for (const pipeline::Estimate& one : estimates)
    out.rows.push_back({std::string(one.name), std::string(one.unit), one.value, one.low, one.high});
  summary.sample = std::move(out);
}

}  // namespace glint::app
