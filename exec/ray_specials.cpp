// Writes what a shader reads of its ray, its hit, its payload and its record of the binding table.
// SPDX-License-Identifier: Apache-2.0
#include "exec/ray_specials.h"

#include <bit>

#include "exec/hit_records.h"
#include "exec/ray_values.h"
#include "rtunit/structure/structure.h"

namespace glint::exec {

using isa::Special;
using isa::Stage;

namespace {

// Holds what the shaders of one stage see of a ray.
struct Seen {
  const rt::Hit& hit;
  float t;
  bool candidate_attributes;
};
Seen seen_by(Stage stage, const rt::RayState& state) {
  switch (stage) {
    case Stage::AnyHit:
      return {state.candidate, state.candidate.t, true};
    case Stage::Intersection:
      return {state.candidate, state.committed.t, true};
    case Stage::Miss:
      return {state.committed, state.ray.t_max, false};
    case Stage::ClosestHit:
    case Stage::RayGeneration:
    case Stage::Callable:
    case Stage::Compute:
      break;
  }
  return {state.committed, state.committed.t, false};
}

void set(WarpContext& warp, size_t lane, Special s, uint32_t value) {
  warp.regs.bank[2][size_t(s) * kLanes + lane] = value;
}
void set_float(WarpContext& warp, size_t lane, Special s, float value) {
  set(warp, lane, s, std::bit_cast<uint32_t>(value));
}
void set_floats(WarpContext& warp, size_t lane, Special first, const float* from, int count) {
  for (int k = 0; k < count; ++k) set_float(warp, lane, Special(int(first) + k), from[k]);
}
void set_record(WarpContext& warp, size_t lane, Address record) {
  const Address data = record + kHandleBytes;
  set(warp, lane, Special::Record, uint32_t(data));
  set(warp, lane, Special::RecordHi, uint32_t(data >> 32));
}

// Returns a word of local memory, or 0 outside of it, where only a program that lies about its addresses can
// lead.
uint32_t local_word(const WarpContext& warp, uint32_t address, size_t lane) {
  const size_t at = size_t(address / 4) * kLanes + lane;
  return at < warp.local.size() ? warp.local[at] : 0;
}

void set_matrices(WarpContext& warp, size_t lane, const rt::InstanceLeaf& leaf, const rt::Ray& ray) {
  set_floats(warp, lane, Special::ObjectToWorld0, leaf.object_to_world.data(), 12);
  set_floats(warp, lane, Special::WorldToObject0, leaf.world_to_object.data(), 12);
  for (size_t axis = 0; axis < 3; ++axis) {
    set_float(warp, lane, Special(size_t(Special::ObjectOriginX) + axis),
              object_point(leaf, ray.origin, axis));
    set_float(warp, lane, Special(size_t(Special::ObjectDirectionX) + axis),
              object_direction(leaf, ray.direction, axis));
  }
}

void fill_ray_specials(const World& world, WarpContext& warp, int lane, const Shader& shader) {
  const size_t i = size_t(lane);
  const TraceFrame& frame = warp.frame();
  const rt::RayState& state = frame.ray[i];
  const Seen seen = seen_by(shader.stage, state);
  set(warp, i, Special::Payload, frame.payload[i]);
  const uint32_t attributes =
      frame.attributes[i] + (seen.candidate_attributes != state.attribute_slot ? kAttributeBytes : 0);
  set(warp, i, Special::Attribute, attributes);
  set_record(warp, i,
             shader.stage == Stage::Miss ? world.table.miss.address(state.ray.miss_index)
                                         : world.table.hit.address(hit_record(world, state.ray, seen.hit)));
  set_float(warp, i, Special::HitT, seen.t);
  set(warp, i, Special::HitKind, seen.hit.kind);
  set_float(warp, i, Special::HitU, seen.hit.u);
  set_float(warp, i, Special::HitV, seen.hit.v);
  // Model: the first two words of an intersection shader's attributes take the place of a triangle's weights,
  // so that a hit shader with a pair of floats serves both.
  if (seen.hit.valid() && seen.hit.kind < rt::kHitKindFront) {
    set(warp, i, Special::HitU, local_word(warp, attributes, i));
    set(warp, i, Special::HitV, local_word(warp, attributes + 4, i));
  }
  set(warp, i, Special::HitPrimitive, seen.hit.primitive);
  set(warp, i, Special::HitGeometry, seen.hit.geometry);
  set(warp, i, Special::HitInstance, seen.hit.instance);
  set(warp, i, Special::HitCustomIndex, seen.hit.custom_index);
  set(warp, i, Special::RayFlags, state.ray.flags);
  set_float(warp, i, Special::RayTmin, state.ray.t_min);
  set(warp, i, Special::RayCullMask, state.ray.cull_mask);
  set_floats(warp, i, Special::RayOriginX, state.ray.origin.data(), 3);
  set_floats(warp, i, Special::RayDirectionX, state.ray.direction.data(), 3);
  if (shader.uses_matrices && seen.hit.valid())
    set_matrices(warp, i, world.memory->view<rt::InstanceLeaf>(seen.hit.instance_leaf, 1)[0], state.ray);
}

}  // namespace

void fill_specials(const World& world, WarpContext& warp, LaneMask lanes, const Shader& shader) {
  if (!shader.uses_ray) return;
  if (shader.stage == Stage::Callable) {
    if (warp.callables == 0) return;
    const CallableFrame& frame = *warp.callable_frames[warp.callables - 1];
    for_each_lane(lanes, [&](int lane) {
      set(warp, size_t(lane), Special::Payload, frame.data[size_t(lane)]);
      set_record(warp, size_t(lane), frame.record[size_t(lane)]);
    });
  } else if (warp.depth == 0) {
    for_each_lane(lanes, [&](int lane) { set_record(warp, size_t(lane), world.table.raygen); });
  } else {
    for_each_lane(lanes, [&](int lane) { fill_ray_specials(world, warp, lane, shader); });
  }
}

}  // namespace glint::exec
