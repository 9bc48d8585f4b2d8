// Makes hit objects, reads them, and traces with what they hold.
// SPDX-License-Identifier: Apache-2.0
#include "exec/hit_objects.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "exec/hit_records.h"
#include "exec/numbered.h"
#include "exec/ray_values.h"
#include "isa/hit_object.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/structure.h"

namespace glint::exec {
namespace {

using isa::HitObjectOp;
using isa::HitObjectValue;

// Names the operands of ho.miss, and of ho.hit up to the SBT stride. Origin, tmin, direction and tmax follow.
enum MissOperand : size_t { kMissIndex = 1, kMissRay };
struct HitOperand {
  enum Slot : size_t { kStructure = 1, kInstance, kPrimitive, kGeometry, kKind, kOffset, kStride };
};

rt::Ray ray_of(const WarpContext& warp, const isa::Inst& inst, size_t first, int lane) {
  rt::Ray ray;
  read_ray(warp.regs, inst, first, lane, ray);
  return ray;
}

// Loads the 16 words of attributes of a lane. Outside of local memory loads give 0, and stores are dropped.
void load_attributes(const WarpContext& warp, uint32_t address, int lane, HitObject& object) {
  for (size_t w = 0; w < object.attributes.size(); ++w) {
    const size_t at = (address / 4 + w) * kLanes + size_t(lane);
    object.attributes[w] = at < warp.local.size() ? warp.local[at] : 0;
  }
}
void store_attributes(WarpContext& warp, uint32_t address, int lane, const HitObject& object) {
  for (size_t w = 0; w < object.attributes.size(); ++w) {
    const size_t at = (address / 4 + w) * kLanes + size_t(lane);
    if (at < warp.local.size()) warp.local[at] = object.attributes[w];
  }
}

// Returns the address of the leaf of an instance below the node at `block`, or 0 when there is none.
Address find_instance(const mem::AddressSpace& memory, const rt::NodeFormat& format, Address structure,
                      uint32_t block, uint32_t instance) {
  std::vector<rt::DecodedChild> children(format.width());
  const auto* node = memory.find(structure + Address(block) * rt::kBlockBytes, format.node_bytes());
  if (!node) return 0;
  const uint32_t count = format.decode(node, children);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t at = rt::block_of(children[i].node);
    if (rt::kind_of(children[i].node) == rt::NodeKind::Internal) {
      if (const Address found = find_instance(memory, format, structure, at, instance)) return found;
    } else if (const auto* leaf =
                   memory.find(structure + Address(at) * rt::kBlockBytes, sizeof(rt::InstanceLeaf))) {
      rt::InstanceLeaf read;
      std::memcpy(&read, leaf, sizeof read);
      if (read.instance == instance) return structure + Address(at) * rt::kBlockBytes;
    }
  }
  return 0;
}

// Does the same for a whole structure. It also returns 0 for what is not a top-level structure.
Address find_instance(const mem::AddressSpace& memory, Address structure, uint32_t instance) {
  rt::StructureHeader header;
  const auto* bytes = memory.find(structure, sizeof header);
  if (!bytes) return 0;
  std::memcpy(&header, bytes, sizeof header);
  if (header.magic != rt::StructureHeader::kMagic || header.level != 1) return 0;
  const rt::NodeFormat* format = rt::find_format(header.format);
  return format ? find_instance(memory, *format, structure, rt::kRootBlock, instance) : 0;
}

}  // namespace

bool HitObjects::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const auto op = HitObjectOp(row.detail);
  LaneMask lanes = warp.regs.exec;
  if (op == HitObjectOp::SetTime || op == HitObjectOp::GetTime)
    return run_time(warp, inst, op == HitObjectOp::SetTime);
  if (op == HitObjectOp::Corner) return run_corner(warp, inst);
  if (lanes && op == HitObjectOp::Record && warp.depth == 0)
    return faults_.fail(warp, std::countr_zero(lanes), "keeps the hit of a trace, and none is open");
  const uint32_t level = warp.depth - (op == HitObjectOp::Record ? 1 : 0);
  const isa::Slot number = inst.operand[op == HitObjectOp::Value ? 1 : 0];
  HitObject* const objects =
      lanes ? find_numbered(faults_, warp, warp.hit_objects, number, level, "hit object") : nullptr;
  if (lanes && !objects) return false;
  for (; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    HitObject& object = objects[lane];
    switch (op) {
      case HitObjectOp::Record:
        if (!record(warp, lane, object)) return false;
        break;
      case HitObjectOp::Empty:
        object = {};
        break;
      case HitObjectOp::Miss:
        object = {HitObject::Type::Miss,
                  ray_of(warp, inst, kMissRay, lane),
                  {},
                  read_word(warp.regs, inst, kMissIndex, lane) & 0xffff,
                  {},
                  std::exchange(warp.next_time[size_t(lane)], 0)};
        break;
      case HitObjectOp::Hit:
      case HitObjectOp::HitAtRecord:
        if (!make_hit(warp, inst, op == HitObjectOp::Hit, lane, object)) return false;
        break;
      case HitObjectOp::Value:
        warp.regs.write(inst.operand[0])[lane] = value_of(object, read_word(warp.regs, inst, 2, lane));
        break;
      case HitObjectOp::SetTime:
      case HitObjectOp::GetTime:
      case HitObjectOp::Corner:
      case HitObjectOp::Reorder:
      case HitObjectOp::ReorderByHint:
      case HitObjectOp::ReorderByTrace:
        break;  // The first three were handled above, and the others are not given to this unit.
      case HitObjectOp::Attributes:
        store_attributes(warp, read_word(warp.regs, inst, 1, lane), lane, object);
        break;
    }
  }
  ++warp.simt.pc;
  return true;
}

// Keeps what the lane's ray of the innermost trace has found.
bool HitObjects::record(WarpContext& warp, int lane, HitObject& object) {
  const TraceFrame& frame = warp.frame();
  rt::RayState& state = warp.ray(lane);
  if (state.broken && !ray_faults_.let_pass_broken(warp, lane, state)) [[unlikely]]
    return false;
  const bool hit = state.committed.valid();
  object = {hit ? HitObject::Type::Hit : HitObject::Type::Miss,
            state.ray,
            state.committed,
            hit ? hit_record(world_, state.ray, state.committed) : state.ray.miss_index,
            {},
            frame.time[size_t(lane)]};
  if (state.committed.kind >= rt::kHitKindFront)
    object.attributes = {as_bits(state.committed.u), as_bits(state.committed.v)};
  else
    load_attributes(warp, frame.attributes[size_t(lane)] + (state.attribute_slot ? kAttributeBytes : 0), lane,
                    object);
  return true;
}

// Reads or sets the time. Outside of any trace the time is 0; only a program that lies about its stage reads
// it there.
bool HitObjects::run_time(WarpContext& warp, const isa::Inst& inst, bool set) {
  if (set) {
    const uint32_t* const from = warp.regs.read(inst.operand[0]);
    for_each_lane(warp.regs.exec, [&](int lane) { warp.next_time[size_t(lane)] = from[lane]; });
  } else {
    uint32_t* const to = warp.regs.write(inst.operand[0]);
    for_each_lane(warp.regs.exec,
                  [&](int lane) { to[lane] = warp.depth == 0 ? 0 : warp.frame().time[size_t(lane)]; });
  }
  ++warp.simt.pc;
  return true;
}

// Model: the corners are read from the leaf that the RT unit tested, at no cost; hardware fetches it again.
bool HitObjects::run_corner(WarpContext& warp, const isa::Inst& inst) {
  const isa::Stage stage = world_.image->shaders[world_.image->shader_of[warp.simt.pc]].stage;
  const uint32_t* const number = warp.regs.read(inst.operand[1]);
  std::array<uint32_t, kLanes> values{};
  for_each_lane(warp.depth == 0 ? 0 : warp.regs.exec, [&](int lane) {
    const rt::RayState& state = warp.ray(lane);
    const rt::Hit& hit = stage == isa::Stage::AnyHit ? state.candidate : state.committed;
    values[size_t(lane)] = as_bits(corner_of(hit, number[lane], *world_.memory));
  });
  uint32_t* const to = warp.regs.write(inst.operand[0]);
  for_each_lane(warp.regs.exec, [&](int lane) { to[lane] = values[size_t(lane)]; });
  ++warp.simt.pc;
  return true;
}

bool HitObjects::make_hit(WarpContext& warp, const isa::Inst& inst, bool has_stride, int lane,
                          HitObject& object) {
  const auto value = [&](size_t operand) { return read_word(warp.regs, inst, operand, lane); };
  const Address structure = read_address(warp.regs, inst, HitOperand::kStructure, lane);
  const Address at = find_instance(*world_.memory, structure, value(HitOperand::kInstance));
  if (at == 0) {
    object = {};
    return faults_.let_pass(warp, lane, FaultKind::Structure, [&] {
      return fmt::format("makes a hit object of instance {}, which {:#x} does not hold: {}",
                         value(HitOperand::kInstance), structure, whereabouts(*world_.memory, structure, 1));
    });
  }
  const rt::InstanceLeaf& leaf = world_.memory->view<rt::InstanceLeaf>(at, 1)[0];
  const size_t ray = HitOperand::kOffset + (has_stride ? 2 : 1);
  object = {HitObject::Type::Hit,
            ray_of(warp, inst, ray, lane),
            {},
            0,
            {},
            std::exchange(warp.next_time[size_t(lane)], 0)};
  object.ray.structure = structure;
  load_attributes(warp, value(ray + kRayOperands), lane, object);
  rt::Hit& hit = object.hit;
  hit.t = object.ray.t_max;
  hit.kind = value(HitOperand::kKind);
  hit.u = as_float(object.attributes[0]);
  hit.v = as_float(object.attributes[1]);
  hit.instance = leaf.instance;
  hit.geometry = value(HitOperand::kGeometry);
  hit.primitive = value(HitOperand::kPrimitive);
  hit.custom_index = leaf.custom_index();
  hit.sbt_record = leaf.sbt_offset();
  hit.instance_leaf = at;
  object.ray.sbt_offset = value(HitOperand::kOffset) & 15;
  object.ray.sbt_stride = has_stride ? value(HitOperand::kStride) & 15 : 0;
  object.record =
      has_stride ? hit_record(world_, object.ray, hit) : world_.table.hit.number(value(HitOperand::kOffset));
  return true;
}

// Returns a value of a hit object. Choice: values that a miss or an empty object does not have are 0.
uint32_t HitObjects::value_of(const HitObject& object, uint32_t value) const {
  using V = HitObjectValue;
  const bool hit = object.type == HitObject::Type::Hit, empty = object.type == HitObject::Type::Empty;
  const rt::Ray& ray = object.ray;
  if (value == uint32_t(V::Type)) return uint32_t(object.type);
  if (empty || value >= uint32_t(V::Count)) return 0;
  const auto within = [&](V first, uint32_t count) {
    return value >= uint32_t(first) && value - uint32_t(first) < count;
  };
  const auto element = [&](V first) { return size_t(value - uint32_t(first)); };
  if (within(V::Origin, 3)) return as_bits(ray.origin[element(V::Origin)]);
  if (within(V::Direction, 3)) return as_bits(ray.direction[element(V::Direction)]);
  if (value == uint32_t(V::Tmin)) return as_bits(ray.t_min);
  if (value == uint32_t(V::Tmax)) return as_bits(hit ? object.hit.t : ray.t_max);
  if (value == uint32_t(V::RecordIndex)) return object.record;
  if (value == uint32_t(V::Time)) return object.time;
  if (within(V::RecordAddress, 2)) {
    const Address data = (hit ? world_.table.hit : world_.table.miss).address(object.record) + kHandleBytes;
    return uint32_t(data >> 32 * element(V::RecordAddress));
  }
  if (!hit) return 0;
  const rt::InstanceLeaf& leaf = world_.memory->view<rt::InstanceLeaf>(object.hit.instance_leaf, 1)[0];
  if (within(V::ObjectOrigin, 3)) return as_bits(object_point(leaf, ray.origin, element(V::ObjectOrigin)));
  if (within(V::ObjectDirection, 3))
    return as_bits(object_direction(leaf, ray.direction, element(V::ObjectDirection)));
  if (within(V::ObjectToWorld, 12)) return as_bits(leaf.object_to_world[element(V::ObjectToWorld)]);
  if (within(V::WorldToObject, 12)) return as_bits(leaf.world_to_object[element(V::WorldToObject)]);
  switch (V(value)) {
    case V::Kind:
      return object.hit.kind;
    case V::Primitive:
      return object.hit.primitive;
    case V::Geometry:
      return object.hit.geometry;
    case V::Instance:
      return object.hit.instance;
    default:
      return object.hit.custom_index;
  }
}

// Opens a trace whose rays have already found what the objects hold.
bool HitObjects::begin_trace(WarpContext& warp, const isa::Inst& inst) {
  LaneMask lanes = warp.regs.exec;
  HitObject* const objects =
      lanes ? find_numbered(faults_, warp, warp.hit_objects, inst.operand[0], warp.depth, "hit object")
            : nullptr;
  if (lanes && !objects) return false;
  if (!rays_.open_trace(warp, inst, 1)) return false;
  for (; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const HitObject& object = objects[lane];
    rt::RayState& state = warp.ray(lane);
    warp.frame().time[size_t(lane)] = object.time;
    state.ray = object.ray;
    state.ray.sbt_offset = state.ray.sbt_stride = 0;  // The record is already known.
    state.ray.miss_index = object.record;
    state.committed = object.hit;
    state.committed.sbt_record = object.record;
    state.candidate = {};
    state.table = nullptr;
    state.attribute_slot = state.broken = false;
    state.status = object.type == HitObject::Type::Empty ? rt::RayStatus::Idle : rt::RayStatus::Done;
    if (object.type == HitObject::Type::Hit && object.hit.kind < rt::kHitKindFront)
      store_attributes(warp, warp.frame().attributes[size_t(lane)], lane, object);
  }
  warp.waiting_for_rays = false;
  ++warp.simt.pc;
  return true;
}

}  // namespace glint::exec
