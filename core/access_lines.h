// Finds which lines of the cache and which banks of shared memory the access of a warp instruction touches.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "core/coalesce.h"
#include "core/lsu.h"
#include "core/params.h"
#include "exec/executor.h"
#include "rtunit/traversal/candidate_table.h"

namespace glint::core {

class AccessLines {
 public:
  AccessLines(const Params& params, const exec::World& world, const exec::Executor& executor,
              const LocalLayout& local, const rt::TableLayout& tables)
      : params_(params), world_(world), executor_(executor), local_(local), tables_(tables) {}

  // Fills in what `access` needs of the caches and of shared memory, for the instruction that the executor
  // has just executed for `warp`.
  void collect(MemoryAccess& access, const exec::WarpContext& warp, const exec::Issued& issued);

 private:
  void collect_mbarriers(MemoryAccess& access, const isa::Access& places) const;
  void collect_texels(MemoryAccess& access, LaneMask lanes) const;
  void collect_ray_data(MemoryAccess& access, const exec::WarpContext& warp, LaneMask lanes);
  void collect_candidates(MemoryAccess& access, const exec::WarpContext& warp, LaneMask lanes) const;
  void collect_memory(MemoryAccess& access, const exec::WarpContext& warp, const exec::Issued& issued) const;

  const Params& params_;
  const exec::World& world_;
  const exec::Executor& executor_;
  const LocalLayout local_;
  const rt::TableLayout tables_;
  uint64_t next_record_ = 0;
};

}  // namespace glint::core
