// Walks rays by code when a machine has no RT unit (exec/traversal_record.h).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/rays.h"
#include "exec/shader_calls.h"

namespace glint::exec {

class CodeTraversal {
 public:
  CodeTraversal(const World& world, Rays& rays, ShaderCalls& calls)
      : world_(world), rays_(rays), calls_(calls) {}

  bool is_used() const { return world_.traversal.shader != kNoShader; }
  // Handles the rays of rt.trace, rt.resume or rq.proceed at `pc`: it calls the traversal program for those
  // that travel. When none travels, the lanes go on waiting, and the machine finishes their rays.
  void walk(WarpContext& warp, uint32_t pc);
  // Takes the rays after the traversal program has returned.
  void take_rays(WarpContext& warp);

 private:
  uint32_t record_of_rays(const WarpContext& warp) const;

  const World& world_;
  Rays& rays_;
  ShaderCalls& calls_;
};

}  // namespace glint::exec
