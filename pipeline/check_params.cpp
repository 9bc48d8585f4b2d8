// Checks keys against each other. Each key's own range is checked when it is read (base/params.h).
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/check_params.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "core/residency.h"
#include "memsys/request.h"
#include "rtunit/unit/rt_unit.h"

namespace glint::pipeline {
namespace {

// Reports a cache that does not consist of whole sets, at least one.
void check_cache(const char* key, uint32_t size, uint32_t ways, uint32_t line, Diagnostics& diagnostics) {
  const uint64_t set = uint64_t{std::max(ways, 1u)} * line;
  if (size >= set && size % set == 0) return;
  diagnostics.error({}, fmt::format("'{}' is {} bytes, expected a multiple of {} bytes ({} ways x {} bytes)",
                                    key, size, set, std::max(ways, 1u), line));
}

void check_code(const core::Params& p, uint32_t line, Diagnostics& diagnostics) {
  if (!std::has_single_bit(line)) return;             // It was reported already.
  if (p.fetch.perfect && p.constant.perfect) return;  // No part of it is built.
  check_cache("core.code_cache.size", p.code_cache.size, p.code_cache.ways, line, diagnostics);
  if (!p.fetch.perfect) check_cache("core.fetch.size", p.fetch.size, p.fetch.ways, line, diagnostics);
  if (p.constant.perfect) return;
  if (!std::has_single_bit(p.constant.line) || p.constant.line > line)
    diagnostics.error(
        {},
        fmt::format(
            "'core.constant.line' is {} bytes, expected a power of two of at most 'memory.line' = {} bytes",
            p.constant.line, line));
  else
    check_cache("core.constant.size", p.constant.size, p.constant.ways, p.constant.line, diagnostics);
}

void check_parking(const core::Params& core, Diagnostics& diagnostics) {
  if (!core.parking.make({})->is_used()) return;
  const uint32_t slots = core::num_warp_slots(core, core.warps),
                 most = core.schedulers * core::kMaxWarpsPerScheduler;
  if (slots > most)
    diagnostics.error(
        {}, fmt::format("'core.warps' and 'core.parking_lot.warps' are {} warps together, expected at "
                        "most {} ({} for each of {} schedulers)",
                        slots, most, core::kMaxWarpsPerScheduler, core.schedulers));
  if (core.reorder.make({})->where() != core::Reorder::Where::Nowhere)
    diagnostics.error(
        {}, fmt::format("core.parking = \"{}\" does not go with core.reorder = \"{}\": threads that "
                        "change their warps would wait for warps without a place",
                        core.parking.name, core.reorder.name));
}

void check_interleaving(const core::Params& core, Diagnostics& diagnostics) {
  if (!core.interleaving.make({})->is_used()) return;
  if (core.reorder.make({})->where() != core::Reorder::Where::Nowhere)
    diagnostics.error(
        {},
        fmt::format("core.interleaving = \"{}\" does not go with core.reorder = \"{}\": threads that change "
                    "their warps would leave results behind that are on the way",
                    core.interleaving.name, core.reorder.name));
  if (core.parking.make({})->is_used())
    diagnostics.error(
        {},
        fmt::format("core.interleaving = \"{}\" does not go with core.parking = \"{}\": paths that wait keep "
                    "values in registers, which a warp without a place does not have",
                    core.interleaving.name, core.parking.name));
}

}  // namespace

void check(const GpuParams& params, Diagnostics& diagnostics) {
  mem::check(params.memory, diagnostics, "memory.");
  check_code(params.core, params.memory.line, diagnostics);
  check_parking(params.core, diagnostics);
  check_interleaving(params.core, diagnostics);
  if (params.rt.request_bytes % mem::kSectorBytes)
    diagnostics.error({},
                      fmt::format("'rt.request_bytes' is {}, expected a multiple of the sector of {} bytes",
                                  params.rt.request_bytes, mem::kSectorBytes));
  if (const std::string why = rt::RtUnit::why_not_together(params.rt); !why.empty())
    diagnostics.error({}, why);
  const std::string who = rt::RtUnit::who_needs_treelets(params.rt);
  if (!who.empty() && !params.bvh.layout.make({})->forms_treelets())
    diagnostics.error({},
                      fmt::format("{} goes by treelets, and bvh.layout = \"{}\" forms none; choose one that "
                                  "does, such as \"treelet_breadth_first\"",
                                  who, params.bvh.layout.name));
  if (params.rt.child_order.make({})->needs_octant_slots() && !params.bvh.format.make({})->has_octant_slots())
    diagnostics.error({},
                      fmt::format("rt.child_order = \"{}\" goes by the octants that children lie in, and "
                                  "bvh.format = \"{}\" does not place them so; choose bvh.format = \"cwbvh\"",
                                  params.rt.child_order.name, params.bvh.format.name));
}

}  // namespace glint::pipeline
