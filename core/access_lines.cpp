// Finds which lines and banks the access of a warp instruction touches.
// SPDX-License-Identifier: Apache-2.0
#include "core/access_lines.h"

#include <bit>
#include <cstdint>

namespace glint::core {

using isa::Effect;
using isa::Space;

void AccessLines::collect(MemoryAccess& access, const exec::WarpContext& warp, const exec::Issued& issued) {
  if (issued.row->effect == Effect::Texture) {
    access.traffic = mem::Traffic::ShaderTexture;
    collect_texels(access, issued.lanes);
  } else if (isa::effect_row(issued.row->effect).family == isa::EffectFamily::Image) {
    access.traffic = mem::Traffic::ShaderSurface;
    collect_texels(access, issued.lanes);
  } else if (isa::is_shader_call(issued.row->effect)) {
    access.traffic = mem::Traffic::ShaderBinding;
    if (issued.row->effect == Effect::CallCandidate) collect_candidates(access, warp, issued.lanes);
    if (issued.row->effect == Effect::CallHit && local_.by_thread)
      collect_ray_data(access, warp, issued.lanes);
    coalesce_global(access.lines, *world_.memory, warp.regs.access, issued.lanes, mem::kSectorBytes);
  } else {
    collect_memory(access, warp, issued);
  }
}

// Collects the entries of the candidates whose shaders are called. Model: the unit makes one read for all of
// a warp's lanes, together with their records of the binding table. What the shaders then read of a candidate
// is in registers. Nested traces use the same memory for their tables, because an outer table is empty by
// then.
void AccessLines::collect_candidates(MemoryAccess& access, const exec::WarpContext& warp,
                                     LaneMask lanes) const {
  if (tables_.rows == 0) return;
  for_each_lane(lanes, [&](int lane) {
    access.lines.add(tables_.entry(access.slot, warp.ray(lane).candidate_row, lane), rt::kTableEntryBytes,
                     lane);
  });
  access.num_table_lines = uint32_t(access.lines.lines().size());
}

// Collects what the shader that a ray ends with reads of the ray: a sector of its record, which is new for
// each ray, and the weights of a triangle. Model: the shader reads both, once, together with its record of
// the binding table.
void AccessLines::collect_ray_data(MemoryAccess& access, const exec::WarpContext& warp, LaneMask lanes) {
  for_each_lane(lanes, [&](int lane) {
    access.lines.add(local_.record(next_record_++), LocalLayout::kRecordBytes, lane);
    const rt::Hit& hit = warp.ray(lane).committed;
    if (hit.valid() && hit.triangle_leaf != 0)
      access.lines.add(local_.attributes(access.slot, lane), LocalLayout::kAttributeBytes, lane);
  });
}

// Collects loads, stores and atomics. Model: lanes of a generic access that are in local memory travel as
// global traffic, and lanes in the constant bank take no time of their own.
void AccessLines::collect_memory(MemoryAccess& access, const exec::WarpContext& warp,
                                 const exec::Issued& issued) const {
  const isa::Access& addresses = warp.regs.access;
  const auto bytes = uint32_t(issued.row->memory.bytes * issued.row->memory.count);
  const bool is_atomic = issued.row->effect == Effect::Atomic, is_copy = issued.row->effect == Effect::Copy;
  access.traffic = is_atomic                                  ? mem::Traffic::ShaderAtomic
                   : issued.row->memory.space == Space::Local ? mem::Traffic::ShaderLocal
                                                              : mem::Traffic::ShaderGlobal;
  access.atomic = is_atomic;
  if (issued.row->effect == Effect::Mbarrier) return collect_mbarriers(access, warp.regs.access);
  if (const uint32_t matrices = issued.row->memory.matrices; matrices > 0) {
    access.is_of_matrices = true;
    access.passes = matrix_passes(addresses, executor_.lanes_in(Space::Shared), matrices, bytes);
    return;
  }
  if (const LaneMask lanes = executor_.lanes_in(Space::Shared))
    access.passes = is_atomic ? bank_passes(addresses, lanes, bytes, !access.merges_lanes)
                              : shared_passes(is_copy ? executor_.copied_to() : addresses, lanes, bytes,
                                              is_copy || issued.row->effect == Effect::Store);
  const LaneMask in_global = executor_.lanes_in(Space::Global);
  if (params_.lsu.bank_conflicts && !is_atomic && in_global)
    access.bank_turns = bank_passes(addresses, in_global, bytes, false);
  coalesce_local(access.lines, local_, access.slot, addresses, executor_.lanes_in(Space::Local), bytes);
  coalesce_global(access.lines, *world_.memory, addresses, in_global, bytes);
  if (is_atomic && in_global)
    count_turns(access.lines, *world_.memory, addresses, bytes, params_.lsu.atomic_turns, !access.write);
}

// Collects barriers in shared memory. Model: an operation takes as long as a load, and lanes that meet at a
// barrier take one turn. On an H200 a lane takes 34 cycles where a load takes 30, 32 lanes at one barrier
// take no longer, and each further barrier takes 10 cycles, where a turn takes 2.
void AccessLines::collect_mbarriers(MemoryAccess& access, const isa::Access& places) const {
  for (LaneMask rest = executor_.lanes_in(Space::Shared); rest; ++access.passes) {
    const Address first = places.address[size_t(std::countr_zero(rest))];
    for_each_lane(rest,
                  [&](int lane) { rest &= ~(LaneMask{places.address[size_t(lane)] == first} << lane); });
  }
}

void AccessLines::collect_texels(MemoryAccess& access, LaneMask lanes) const {
  access.samples = uint32_t(std::popcount(lanes)) * uint32_t((executor_.texels().rows().size() + 3) / 4);
  for (const auto& row : executor_.texels().rows())
    for_each_lane(lanes, [&](int lane) {
      const Address texel = row[size_t(lane)];
      if (texel != exec::TexelList::kNone) access.lines.add(world_.memory->physical(texel), 4, lane);
    });
}

}  // namespace glint::core
