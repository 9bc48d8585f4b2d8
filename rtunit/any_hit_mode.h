// When intersection and any-hit shaders run: the interface of the any-hit modes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "base/policy_kinds.h"
#include "rtunit/traversal/candidate_table.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Contract (tests/contract/rt_any_hit_mode_test.cpp):
//  - without a table, rays stop at each candidate and present() is never called;
//  - present() takes a candidate out of the table of at least one of the lanes, of none more than one, and of
//  no other lane;
//  - the choice depends on the arguments alone: a mode has no state and serves all cores.
class AnyHitMode {
 public:
  static constexpr PolicyKind kKind{"rt.any_hit", "rtunit/any_hit"};
  struct Context {};
  static constexpr uint32_t kNoShader = ~0u;
  // The shader that a lane's candidate needs, or kNoShader: it is decided without one.
  using ShaderOf = std::function<uint32_t(int lane, const Candidate& candidate)>;

  virtual ~AnyHitMode() = default;
  // Candidates that a ray's table holds, at most kMaxTableRows; 0: no table.
  virtual uint32_t table_rows() const = 0;
  // Of the rays `lanes`, all Gathered: chooses who runs which candidate next, and rt::present()s it. The
  // others wait.
  virtual void present(RayState* rays, LaneMask lanes, const ShaderOf& shader_of) const = 0;
};

}  // namespace glint::rt
