// Declares the interface of the policies that choose when intersection and any-hit shaders run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "base/registry.h"
#include "rtunit/traversal/candidate_table.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::rt {

// Contract (tests/contract/rt_any_hit_mode_test.cpp):
//  - Without a table, rays stop at each candidate and present() is never called.
//  - present() takes one candidate out of the tables of some of the lanes, at least one lane, and none out of
//    any other table.
//  - The choice depends on the arguments alone: a mode has no state and serves all cores.
class AnyHitMode {
 public:
  static constexpr PolicyKind kKind{"rt.any_hit", "rtunit/any_hit"};
  struct Context {};
  static constexpr uint32_t kNoShader = ~0u;
  // Returns the shader that a lane's candidate needs, or kNoShader when it is decided without one.
  using ShaderOf = std::function<uint32_t(int lane, const Candidate& candidate)>;

  virtual ~AnyHitMode() = default;
  // Returns how many candidates a ray's table holds, at most kMaxTableRows. 0 means that rays have no table.
  virtual uint32_t table_rows() const = 0;
  // Chooses which of the lanes run which candidate next and calls rt::present() for them; the others wait.
  // The rays of all `lanes` have Gathered candidates.
  virtual void present(RayState* rays, LaneMask lanes, const ShaderOf& shader_of) const = 0;
};

}  // namespace glint::rt
