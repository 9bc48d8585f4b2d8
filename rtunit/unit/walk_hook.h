// Declares the interface of the parts that add something to the steps of a ray's walk.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "rtunit/visit.h"

namespace glint::rt {

// RayWalk calls its hooks at each step in the order in which they were added.
class WalkHook {
 public:
  virtual ~WalkHook() = default;
  // Tells that a ray enters the unit, for the first time (no node visited yet) or after a shader.
  virtual void entered(uint32_t /*slot*/, int /*lane*/, Cycle /*now*/) {}
  // Tells that a ray that was in the unit has come into this lane (rt.pool). What a hook knows by lane, it
  // learns as for a ray that enters.
  virtual void moved(uint32_t slot, int lane, Cycle now) { entered(slot, lane, now); }
  // Tells that the lane is about to want its ray's next node, or to stop. Returns true when something else
  // comes first: the hook has made the lane want a read of its own, or calls RayWalk::go_on() when it is
  // done.
  virtual bool detour(uint32_t /*slot*/, int /*lane*/, Cycle /*now*/) { return false; }
  // Tells that the test of a read that the hook asked for has started.
  virtual void errand_started(uint32_t /*slot*/, int /*lane*/) {}
  // Tells that the test of the ray's node has started; the traversal has made its step.
  virtual void visited(const Visit&) {}
  // Tells that the test of the lane's read has ended, whoever asked for it.
  virtual void test_ended(uint32_t /*slot*/, int /*lane*/) {}
  // Tells that the lane's own ray goes back to the core, because its walk has ended or it needs a shader.
  virtual void stopped(uint32_t /*slot*/, int /*lane*/) {}
};

}  // namespace glint::rt
