// Lets two threads of different warps change places.
// SPDX-License-Identifier: Apache-2.0
#include "exec/lane_moves.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "base/num_lanes.h"
#include "isa/inst.h"

namespace glint::exec {
namespace {

using isa::Special;
using Entry = SimtStack::Entry;

// Names the specials that belong to the lane, the warp slot or the core rather than to the thread. The clock
// is written anew before each instruction that reads it.
constexpr bool stays(Special special) {
  return special == Special::LaneId || (special >= Special::WarpId && special <= Special::GridId) ||
         (special >= Special::LanemaskEq && special <= Special::LanemaskGt);
}

bool is_meeting(const Entry& entry) {
  return entry.kind == SimtStack::Kind::Join || entry.kind == SimtStack::Kind::Call;
}

bool is_same_meeting(const Entry& a, const Entry& b) {
  return a.kind == b.kind && a.pc == b.pc && a.depth == b.depth && a.shader == b.shader &&
         a.callables == b.callables && a.is_function == b.is_function && a.is_traversal == b.is_traversal;
}

// Calls visit(i, j) for each place where lanes meet, with the numbers of its entries in the two stacks, until
// visit returns false. Returns false then, or when the stacks have different places.
template <class Visit>
bool for_each_meeting(const SimtStack& a, const SimtStack& b, Visit&& visit) {
  const auto &of_a = a.entries(), &of_b = b.entries();
  size_t i = 0, j = 0;
  for (;; ++i, ++j) {
    while (i < of_a.size() && !is_meeting(of_a[i])) ++i;
    while (j < of_b.size() && !is_meeting(of_b[j])) ++j;
    if (i == of_a.size() || j == of_b.size()) return i == of_a.size() && j == of_b.size();
    if (!visit(i, j)) return false;
  }
}

template <class Value>
void swap_rows(Value* a, int i, Value* b, int j, size_t rows) {
  for (size_t row = 0; row < rows; ++row) std::swap(a[row * kLanes + size_t(i)], b[row * kLanes + size_t(j)]);
}

template <class Value>
void swap_in(std::array<Value, kLanes>& a, int i, std::array<Value, kLanes>& b, int j) {
  std::swap(a[size_t(i)], b[size_t(j)]);
}

// Gives the frame tables of candidates if the other one has some. They are made when first used.
void match_tables(TraceFrame& frame, const TraceFrame& other) {
  if (!frame.tables.empty() || other.tables.empty()) return;
  frame.tables.resize(kLanes);
  for (rt::CandidateTable& table : frame.tables) table.row.resize(other.tables[0].row.size());
}

void swap_frames(TraceFrame& a, int i, TraceFrame& b, int j) {
  match_tables(a, b);
  match_tables(b, a);
  if (!a.tables.empty()) std::swap(a.tables[size_t(i)], b.tables[size_t(j)]);
  swap_in(a.payload, i, b.payload, j);
  swap_in(a.attributes, i, b.attributes, j);
  swap_in(a.time, i, b.time, j);
  if (!a.outer && !b.outer) return;
  for (TraceFrame* frame : {&a, &b})
    if (!frame->outer) frame->outer = std::make_unique<std::array<EndedRay, kLanes>>();
  swap_in(*a.outer, i, *b.outer, j);
  swap_bits(a.kept, i, b.kept, j);
}

// Lets the lane's rays of all levels that it has opened use the tables of the lane's new warp.
void take_tables(WarpContext& warp, int lane) {
  const auto use_table_of = [&](size_t level, rt::CandidateTable*& table) {
    std::vector<rt::CandidateTable>& tables = warp.frames[level]->tables;
    if (table && !tables.empty()) table = &tables[size_t(lane)];
  };
  size_t level = 0;
  for (; level + 1 < warp.depth && warp.frames[level + 1]->kept >> lane & 1; ++level)
    use_table_of(level, (*warp.frames[level + 1]->outer)[size_t(lane)].table);
  use_table_of(level, warp.ray(lane).table);
}

void swap_rays(WarpContext& a, int i, WarpContext& b, int j) {
  if (a.depth == 0) return;
  for (uint32_t level = 0; level < a.depth; ++level) swap_frames(*a.frames[level], i, *b.frames[level], j);
  swap_in(*a.traced, i, *b.traced, j);
  take_tables(a, i);
  take_tables(b, j);
}

// Objects are made when first used, so that only one of the warps may have some of them.
template <class Object>
void swap_numbered(Numbered<Object>& a, int i, Numbered<Object>& b, int j, uint32_t levels) {
  const size_t count = std::min(std::max(a.size(), b.size()), size_t{levels} * kMaxNumbered);
  for (Numbered<Object>* objects : {&a, &b})
    if (objects->size() < count) objects->resize(count);
  for (size_t n = 0; n < count; ++n) {
    if (!a[n] && !b[n]) continue;
    for (Numbered<Object>* objects : {&a, &b})
      if (!(*objects)[n]) (*objects)[n] = std::make_unique<std::array<Object, kLanes>>();
    swap_in(*a[n], i, *b[n], j);
  }
}

void swap_specials(isa::Warp& a, int i, isa::Warp& b, int j, const Image& image) {
  for (size_t s = 0; s < image.special_row.size(); ++s) {
    const size_t row = image.special_row[s];
    if (row != Image::kNoRow && !stays(Special(s)))
      swap_rows(a.bank[2] + row * kLanes, i, b.bank[2] + row * kLanes, j, 1);
  }
}

}  // namespace

bool can_exchange(const WarpContext& a, const WarpContext& b) {
  return !a.simt.has_switched() && !b.simt.has_switched() && a.simt.pc == b.simt.pc && a.depth == b.depth &&
         a.callables == b.callables && for_each_meeting(a.simt, b.simt, [&](size_t i, size_t j) {
           return is_same_meeting(a.simt.entries()[i], b.simt.entries()[j]);
         });
}

LaneMask movable_lanes(const WarpContext& warp) {
  LaneMask lanes = kAllLanes;
  for (const Entry& entry : warp.simt.entries())
    if (!is_meeting(entry)) lanes &= ~entry.lanes;
  return lanes;
}

void swap_threads(WarpContext& a, int i, WarpContext& b, int j, const Image& image) {
  swap_rows(a.regs.bank[0], i, b.regs.bank[0], j, image.num_registers);
  swap_specials(a.regs, i, b.regs, j, image);
  for (size_t p = 0; p < a.regs.predicate.size(); ++p)
    swap_bits(a.regs.predicate[p], i, b.regs.predicate[p], j);
  swap_rows(a.local.data(), i, b.local.data(), j, a.local.size() / kLanes);
  swap_in(a.next_time, i, b.next_time, j);
  swap_rays(a, i, b, j);
  for (uint32_t depth = 0; depth < a.callables; ++depth) {
    swap_in(a.callable_frames[depth]->data, i, b.callable_frames[depth]->data, j);
    swap_in(a.callable_frames[depth]->record, i, b.callable_frames[depth]->record, j);
  }
  swap_numbered(a.hit_objects, i, b.hit_objects, j, a.depth + 1);
  swap_numbered(a.queries, i, b.queries, j, a.depth + 1);
  swap_bits(a.simt.active, i, b.simt.active, j);
  for_each_meeting(a.simt, b.simt, [&](size_t m, size_t n) {
    swap_bits(a.simt.lanes_at(m), i, b.simt.lanes_at(n), j);
    return true;
  });
}

}  // namespace glint::exec
