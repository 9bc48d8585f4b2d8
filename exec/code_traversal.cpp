// Calls the traversal program, and writes and reads its record.
// SPDX-License-Identifier: Apache-2.0
#include "exec/code_traversal.h"

#include <bit>
#include <cstring>

#include "base/check.h"
#include "exec/ray_values.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/traversal.h"

namespace glint::exec {
namespace {

// Holds a lane's record.
class Record {
 public:
  Record(WarpContext& warp, uint32_t address, int lane)
      : words_(&warp.local[size_t(address / 4) * kLanes + size_t(lane)]) {}

  uint32_t& operator[](uint32_t word) { return words_[size_t(word) * kLanes]; }
  float real(uint32_t word) { return as_float((*this)[word]); }
  void set(uint32_t word, float value) { (*this)[word] = as_bits(value); }
  void set_address(uint32_t word, Address value) {
    (*this)[word] = uint32_t(value);
    (*this)[word + 1] = uint32_t(value >> 32);
  }

 private:
  uint32_t* words_;
};

bool read_leaf(const mem::AddressSpace& memory, Address address, rt::InstanceLeaf& leaf) {
  const auto* bytes = memory.find(address, sizeof leaf);
  if (bytes) std::memcpy(&leaf, bytes, sizeof leaf);
  return bytes != nullptr;
}

// Returns the block that names a leaf: in the ray's structure for an instance, and in the instance's
// structure for a triangle.
uint32_t block_of_leaf(Address leaf, Address structure) {
  return leaf ? uint32_t((leaf - structure) / rt::kBlockBytes) : 0;
}
Address leaf_of_block(uint32_t block, Address structure) {
  return block ? structure + Address(block) * rt::kBlockBytes : 0;
}

void put_hit(Record& record, uint32_t word, const rt::Ray& ray, const rt::Hit& hit,
             const mem::AddressSpace& memory) {
  record.set(word, hit.t);
  record.set(word + 1, hit.u);
  record.set(word + 2, hit.v);
  record[word + 3] = hit.kind;
  record[word + 4] = hit.geometry;
  record[word + 5] = hit.primitive;
  record[word + 6] = block_of_leaf(hit.instance_leaf, ray.structure);
  rt::InstanceLeaf leaf;
  record[word + 7] = hit.triangle_leaf && read_leaf(memory, hit.instance_leaf, leaf)
                         ? block_of_leaf(hit.triangle_leaf, leaf.structure)
                         : 0;
}

// Reads a hit from the record. Returns false when the record names something that is not a leaf.
bool get_hit(Record& record, uint32_t word, const rt::Ray& ray, const mem::AddressSpace& memory,
             rt::Hit& hit) {
  hit = rt::Hit{};
  hit.t = record.real(word);
  hit.instance_leaf = leaf_of_block(record[word + 6], ray.structure);
  if (hit.instance_leaf == 0) return true;
  rt::InstanceLeaf leaf;
  if (!read_leaf(memory, hit.instance_leaf, leaf)) return false;
  hit.u = record.real(word + 1);
  hit.v = record.real(word + 2);
  hit.kind = record[word + 3];
  hit.geometry = record[word + 4];
  hit.primitive = record[word + 5];
  hit.triangle_leaf = leaf_of_block(record[word + 7], leaf.structure);
  hit.instance = leaf.instance;
  hit.custom_index = leaf.custom_index();
  hit.sbt_record = leaf.sbt_offset();
  return true;
}

using namespace traversal_word;

void put_ray(Record record, rt::RayState& state, uint32_t stack_entries) {
  const rt::Ray& ray = state.ray;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    record.set(kOrigin + axis, ray.origin[axis]);
    record.set(kDirection + axis, ray.direction[axis]);
  }
  record.set(kTmin, ray.t_min);
  record.set(kTmax, ray.t_max);
  record[kFlags] = ray.flags;
  record[kMask] = ray.cull_mask;
  record.set_address(kStructure, ray.structure);
  record[kEndsAtFirstHit] = state.rules.end_at_first_hit && (ray.flags & rt::ray_flag::kTerminateOnFirstHit);
  record[kInstanceBlock] = 0;
  record[kStackRoom] = stack_entries;
  record[kTopLevelEntries] = ~0u;
  record[kStackSize] = 1;
  record[kStack] = rt::node_ref(rt::kRootBlock, rt::NodeKind::Internal);
  record.set(kStack + 1, ray.t_min);
  state.rules.in_code = true;
  state.stack_size = 0;
}

void take_ray(Record record, rt::RayState& state, const mem::AddressSpace& memory) {
  const auto status = WalkStatus(record[kStatus]);
  if (status > WalkStatus::NeedsIntersectionOpaque ||
      !get_hit(record, kHit, state.ray, memory, state.committed))
    return rt::break_off(state);
  state.status = rt::RayStatus::Done;
  if (status == WalkStatus::Done) return;
  if (!get_hit(record, kCandidate, state.ray, memory, state.candidate) || !state.candidate.valid())
    return rt::break_off(state);
  state.candidate_procedural = status != WalkStatus::NeedsAnyHit;
  state.candidate_opaque = status == WalkStatus::NeedsIntersectionOpaque;
  state.status = state.candidate_procedural ? rt::RayStatus::NeedsIntersection : rt::RayStatus::NeedsAnyHit;
}

}  // namespace

// Returns where the records of the waiting rays lie: those of the innermost trace, or of a ray query.
uint32_t CodeTraversal::record_of_rays(const WarpContext& warp) const {
  const TraversalCode& code = world_.traversal;
  uint32_t index = warp.depth - 1;
  if (warp.depth == 0 || warp.rays != warp.traced->data()) {
    uint32_t place = 0;
    while (!warp.queries[place] || warp.queries[place]->data() != warp.rays) ++place;
    GLINT_DCHECK(place % kMaxNumbered < code.queries, "ray query {} has no record", place % kMaxNumbered);
    index = world_.max_trace_depth + place / kMaxNumbered * code.queries + place % kMaxNumbered;
  }
  return code.first_record + index * code.record_bytes();
}

// Handles the rays of rt.trace, rt.resume or rq.proceed at `pc`: it calls the traversal program for those
// that travel. When none travels, the lanes go on waiting, and the machine finishes their rays. Model: the
// ray goes to its record, and so does the verdict of an any-hit shader, without instructions of their own.
void CodeTraversal::walk(WarpContext& warp, uint32_t pc) {
  LaneMask travelling = 0;
  for_each_lane(warp.ray_lanes, [&](int lane) {
    travelling |= LaneMask{warp.rays[lane].status == rt::RayStatus::Traversing} << lane;
  });
  if (!travelling) return;
  const Shader& code = world_.image->shaders[world_.traversal.shader];
  const uint32_t at = record_of_rays(warp);
  const uint8_t payload = world_.image->special_row[size_t(isa::Special::Payload)];
  for_each_lane(travelling, [&](int lane) {
    rt::RayState& state = warp.rays[lane];
    Record record(warp, at, lane);
    if (state.stack_size > 0)
      put_ray(record, state, world_.traversal.stack_entries);  // in the state that begin() left
    put_hit(record, kHit, state.ray, state.committed, *world_.memory);
    if (payload != Image::kNoRow) warp.regs.bank[2][payload * size_t(kLanes) + size_t(lane)] = at;
  });
  calls_.count_called(code.stage, uint64_t(std::popcount(travelling)));
  SimtStack& simt = warp.simt;
  simt.push_call(simt.pc, simt.active & ~travelling, warp.depth, world_.image->shader_of[pc], warp.callables);
  simt.mark_traversal();
  simt.pc = code.entry;
  simt.active = travelling;
  warp.walking = travelling;
  warp.waiting_for_rays = false;
}

void CodeTraversal::take_rays(WarpContext& warp) {
  const uint32_t at = record_of_rays(warp);
  for_each_lane(warp.walking,
                [&](int lane) { take_ray(Record(warp, at, lane), warp.rays[lane], *world_.memory); });
  rays_.finish(warp);
}

}  // namespace glint::exec
