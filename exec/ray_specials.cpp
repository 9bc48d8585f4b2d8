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

// Writes the specials of one lane that its shader reads. The others keep old values, which nobody sees: each
// special of a warp lies in cache lines of its own.
struct LaneSpecials {
  WarpContext& warp;
  size_t lane;
  const Image& image;
  const isa::SpecialSet& read;  // Shader::specials_used

  void set(Special s, uint32_t value) const {
    if (read[size_t(s)]) warp.regs.bank[2][image.special_row[size_t(s)] * size_t(kLanes) + lane] = value;
  }
  void set_float(Special s, float value) const { set(s, std::bit_cast<uint32_t>(value)); }
  void set_floats(Special first, const float* from, int count) const {
    for (int k = 0; k < count; ++k) set_float(Special(int(first) + k), from[k]);
  }
  void set_record(Address record) const {
    const Address data = record + kHandleBytes;
    set(Special::Record, uint32_t(data));
    set(Special::RecordHi, uint32_t(data >> 32));
  }
};

// Returns a word of local memory, or 0 outside of it, where only a program that lies about its addresses can
// lead.
uint32_t local_word(const WarpContext& warp, uint32_t address, size_t lane) {
  const size_t at = size_t(address / 4) * kLanes + lane;
  return at < warp.local.size() ? warp.local[at] : 0;
}

void set_matrices(const LaneSpecials& out, const rt::InstanceLeaf& leaf, const rt::Ray& ray) {
  out.set_floats(Special::ObjectToWorld0, leaf.object_to_world.data(), 12);
  out.set_floats(Special::WorldToObject0, leaf.world_to_object.data(), 12);
  for (size_t axis = 0; axis < 3; ++axis) {
    out.set_float(Special(size_t(Special::ObjectOriginX) + axis), object_point(leaf, ray.origin, axis));
    out.set_float(Special(size_t(Special::ObjectDirectionX) + axis),
                  object_direction(leaf, ray.direction, axis));
  }
}

void fill_ray_specials(const World& world, WarpContext& warp, int lane, const Shader& shader) {
  const size_t i = size_t(lane);
  const TraceFrame& frame = warp.frame();
  const rt::RayState& state = warp.ray(lane);
  const Seen seen = seen_by(shader.stage, state);
  const LaneSpecials out{warp, i, *world.image, shader.specials_used};
  out.set(Special::Payload, frame.payload[i]);
  const uint32_t attributes =
      frame.attributes[i] + (seen.candidate_attributes != state.attribute_slot ? kAttributeBytes : 0);
  out.set(Special::Attribute, attributes);
  out.set_record(shader.stage == Stage::Miss
                     ? world.table.miss.address(state.ray.miss_index)
                     : world.table.hit.address(hit_record(world, state.ray, seen.hit)));
  out.set_float(Special::HitT, seen.t);
  out.set(Special::HitKind, seen.hit.kind);
  out.set_float(Special::HitU, seen.hit.u);
  out.set_float(Special::HitV, seen.hit.v);
  // Model: the first two words of an intersection shader's attributes take the place of a triangle's weights,
  // so that a hit shader with a pair of floats serves both.
  if (seen.hit.valid() && seen.hit.kind < rt::kHitKindFront) {
    out.set(Special::HitU, local_word(warp, attributes, i));
    out.set(Special::HitV, local_word(warp, attributes + 4, i));
  }
  out.set(Special::HitPrimitive, seen.hit.primitive);
  out.set(Special::HitGeometry, seen.hit.geometry);
  out.set(Special::HitInstance, seen.hit.instance);
  out.set(Special::HitCustomIndex, seen.hit.custom_index);
  out.set(Special::RayFlags, own_flags(world, state.ray.flags));
  out.set_float(Special::RayTmin, state.ray.t_min);
  out.set(Special::RayCullMask, state.ray.cull_mask);
  out.set_floats(Special::RayOriginX, state.ray.origin.data(), 3);
  out.set_floats(Special::RayDirectionX, state.ray.direction.data(), 3);
  if (shader.uses_matrices && seen.hit.valid())
    set_matrices(out, world.memory->view<rt::InstanceLeaf>(seen.hit.instance_leaf, 1)[0], state.ray);
}

}  // namespace

void fill_specials(const World& world, WarpContext& warp, LaneMask lanes, const Shader& shader) {
  if (!shader.uses_ray) return;
  if (shader.stage == Stage::Callable) {
    if (warp.callables == 0) return;
    const CallableFrame& frame = *warp.callable_frames[warp.callables - 1];
    for_each_lane(lanes, [&](int lane) {
      const LaneSpecials out{warp, size_t(lane), *world.image, shader.specials_used};
      out.set(Special::Payload, frame.data[size_t(lane)]);
      out.set_record(frame.record[size_t(lane)]);
    });
  } else if (warp.depth == 0) {
    for_each_lane(lanes, [&](int lane) {
      LaneSpecials{warp, size_t(lane), *world.image, shader.specials_used}.set_record(world.table.raygen);
    });
  } else {
    for_each_lane(lanes, [&](int lane) { fill_ray_specials(world, warp, lane, shader); });
  }
}

}  // namespace glint::exec
