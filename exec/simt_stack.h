// Implements the SIMT stack: which lanes of a warp run now, which wait, and where they meet again.
//
// Entries are of three kinds:
//  - Path: lanes that will run from `pc` later.
//  - Join: lanes that have arrived at the reconvergence point `pc` (a `join` instruction) and wait for the
//    rest.
//  - Call: lanes that have returned from a call and wait for the rest; they resume at `pc`.
// Each entry, and the path that runs, knows the Join or Call that encloses it. When the running lanes are
// used up, their path has ended. If it was the last one that its Join or Call waited for, the lanes that have
// arrived there go on, and otherwise the last Path runs. Because lanes arrive at any enclosing Join, not only
// at the innermost, break, continue and early exits out of several constructs need no special case.
//
// Whoever wants another order may let a Path run before the running one has ended (switch_to).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/types.h"

namespace glint::exec {

class SimtStack {
 public:
  // An entry that has gone is a place for another one.
  enum class Kind : uint8_t { Path, Join, Call, Gone };
  static constexpr uint32_t kNone = ~0u;
  // Choice: calls may be nested up to this depth. Programs with a stack of their own end long before, which
  // catches recursion without end.
  static constexpr size_t kMaxDepth = 1 << 16;
  struct Entry {
    Kind kind;
    uint32_t pc;
    LaneMask lanes;
    uint32_t enclosing = kNone;  // the index of the Join or Call around it
    uint32_t open = 0;           // Join, Call: paths, joins and calls right inside of it that have not ended
    uint32_t depth = 0;          // Call: trace depth to return to
    uint32_t shader = 0;         // Call: the caller's shader
    uint32_t callables = 0;      // Call: callable depth to return to
    bool is_function = false;    // Call: of a function of the same shader, not of another shader
    bool is_traversal = false;   // Call: of the program that walks rays
    bool has_begun = false;      // Path: it has run before, and another one was preferred
    bool waits = false;          // Path: it waits at its instruction for other lanes
  };

  uint32_t pc = 0;
  LaneMask active = 0;

  void start(uint32_t entry_pc, LaneMask lanes) {
    entries_.clear();
    enclosing_ = kNone;
    gone_ = 0;
    has_switched_ = has_yielded_ = false;
    pc = entry_pc;
    active = lanes;
  }
  bool finished() const { return active == 0; }

  void push_reconvergence(uint32_t join_pc) { enclose({Kind::Join, join_pc, 0}); }
  void push_path(uint32_t path_pc, LaneMask lanes) {
    if (enclosing_ != kNone) ++entries_[enclosing_].open;
    push({Kind::Path, path_pc, lanes, enclosing_});
  }
  void push_call(uint32_t return_pc, LaneMask arrived, uint32_t depth, uint32_t shader,
                 uint32_t callables = 0, bool is_function = false) {
    Entry call{Kind::Call, return_pc, arrived};
    call.depth = depth;
    call.shader = shader;
    call.callables = callables;
    call.is_function = is_function;
    enclose(call);
  }

  // Notes that the call pushed last is of the program that walks rays.
  void mark_traversal() { entries_[enclosing_].is_traversal = true; }

  // Lets lanes that reach the join at `join_pc` wait in its entry. The caller then removes them from the
  // running set. Returns false when no enclosing ssy names the place, which is a malformed program.
  bool arrive(uint32_t join_pc, LaneMask lanes) {
    for (uint32_t i = enclosing_; i != kNone && entries_[i].kind == Kind::Join; i = entries_[i].enclosing) {
      if (entries_[i].pc != join_pc) continue;
      entries_[i].lanes |= lanes;
      return true;
    }
    return false;
  }
  // Returns the innermost call, of a shader or of either kind, or null when nobody called.
  const Entry* innermost_call(bool of_shader) const {
    for (uint32_t i = enclosing_; i != kNone; i = entries_[i].enclosing)
      if (entries_[i].kind == Kind::Call && !(of_shader && entries_[i].is_function)) return &entries_[i];
    return nullptr;
  }
  // Lets lanes return to the innermost call, or to that of the shader, out of all functions. Returns false
  // when nobody called.
  bool arrive_return(LaneMask lanes, bool of_shader = false) {
    const Entry* call = innermost_call(of_shader);
    if (!call) return false;
    entries_[size_t(call - entries_.data())].lanes |= lanes;
    return true;
  }
  // Returns all lanes that have not ended, wherever they wait.
  LaneMask live() const {
    LaneMask lanes = active;
    for (const Entry& entry : entries_) lanes |= entry.lanes;
    return lanes;
  }

  // While no lanes run, ends the path that ran and takes what comes next, until some lanes run or none are
  // left. When a Call entry resumed, it returns true and puts the entry into *resumed_call.
  bool resume_next(Entry* resumed_call) {
    bool resumed = false;
    while (active == 0 && !entries_.empty()) {
      const bool is_last = enclosing_ != kNone && --entries_[enclosing_].open == 0;
      const Entry next = take(is_last ? enclosing_ : last_path());
      active = next.lanes;
      pc = next.kind == Kind::Join ? next.pc + 1 : next.pc;
      enclosing_ = next.enclosing;
      if (next.kind == Kind::Call) {  // Even with no lanes left, its context is the caller's again.
        *resumed_call = next;
        resumed = true;
      }
    }
    return resumed;
  }

  // Returns whether entry `index` is in the same shader's or function's run as the path that runs, so that
  // both see the same calls and traces.
  bool is_in_frame(size_t index) const {
    return call_around(entries_[index].enclosing) == call_around(enclosing_);
  }
  // Lets the lanes of entry `index` run, a Path or a Join in the frame of the path that runs. The latter
  // waits as a Path. Lanes that have arrived at a Join go on without the others, which arrive there later.
  void switch_to(size_t index) { change_to(index, false); }
  // Does the same for lanes that wait in vain for others of their warp.
  void yield_to(size_t index) {
    switch_to(index);
    has_yielded_ = true;
  }
  // Lets the path of entry `index` run, and the running one wait at its instruction until take_waiting() is
  // called there, or until no other one can run.
  void wait_for(size_t index) { change_to(index, true); }
  // Returns whether entry `index` is a path that does not wait at its instruction.
  bool can_run(size_t index) const { return entries_[index].kind == Kind::Path && !entries_[index].waits; }
  // Takes the lanes that wait at the instruction of the running path into that path: those inside of the same
  // joins, or with `from_anywhere` all of the frame.
  void take_waiting(bool from_anywhere) {
    for (size_t i = entries_.size(); i-- > 0;) {
      if (i >= entries_.size() || !entries_[i].waits || entries_[i].pc != pc || !is_in_frame(i)) continue;
      if (entries_[i].enclosing != enclosing_ && !from_anywhere) continue;
      const Entry from = take(uint32_t(i));
      active |= from.lanes;
      leave(from.enclosing);
    }
  }
  // Return whether paths have changed before they ended, and whether one has yielded, since the start.
  bool has_switched() const { return has_switched_; }
  bool has_yielded() const { return has_yielded_; }

  size_t depth() const { return entries_.size(); }
  const std::vector<Entry>& entries() const { return entries_; }
  // Returns the lanes of entry `index`, for who moves threads to lanes of other warps.
  LaneMask& lanes_at(size_t index) { return entries_[index].lanes; }

 private:
  void change_to(size_t index, bool waits) {
    Entry from{Kind::Path, pc, active, enclosing_};
    from.has_begun = true;
    from.waits = waits;
    Entry& to = entries_[index];
    const bool is_join = to.kind == Kind::Join;
    pc = is_join ? to.pc + 1 : to.pc;
    active = std::exchange(to.lanes, 0);
    enclosing_ = to.enclosing;
    if (is_join && enclosing_ != kNone) ++entries_[enclosing_].open;
    if (!is_join) take(uint32_t(index));
    push(from);
    has_switched_ = true;
  }
  // Notes that a path inside of entry `index` has gone elsewhere. If it was the last one there, the lanes
  // that have arrived are a path, or there is nothing left to wait for.
  void leave(uint32_t index) {
    while (index != kNone && --entries_[index].open == 0) {
      Entry& join = entries_[index];
      if (join.lanes) {
        join.kind = Kind::Path;
        ++join.pc;
        return;
      }
      index = take(index).enclosing;
    }
  }
  uint32_t push(const Entry& entry) {
    if (gone_ > 0) [[unlikely]] {
      --gone_;
      uint32_t place = 0;
      while (entries_[place].kind != Kind::Gone) ++place;
      entries_[place] = entry;
      return place;
    }
    entries_.push_back(entry);
    return uint32_t(entries_.size() - 1);
  }
  // Pushes a Join or Call, which from now on encloses the path that runs. What enclosed that path before
  // waits for the new entry in its place.
  void enclose(Entry entry) {
    entry.enclosing = enclosing_;
    entry.open = 1;
    enclosing_ = push(entry);
  }
  // Removes an entry and returns it. Entries leave from the end, unless paths were switched.
  Entry take(uint32_t index) {
    const Entry entry = entries_[index];
    entries_[index].kind = Kind::Gone;
    entries_[index].lanes = 0;
    entries_[index].waits = false;
    ++gone_;
    while (!entries_.empty() && entries_.back().kind == Kind::Gone) {
      entries_.pop_back();
      --gone_;
    }
    return entry;
  }
  uint32_t last_path() const {
    auto index = uint32_t(entries_.size() - 1);
    while (entries_[index].kind != Kind::Path) --index;
    return index;
  }
  uint32_t call_around(uint32_t index) const {
    while (index != kNone && entries_[index].kind != Kind::Call) index = entries_[index].enclosing;
    return index;
  }

  std::vector<Entry> entries_;  // It grows once to the program's nesting, then allocates nothing.
  uint32_t enclosing_ = kNone;  // what encloses the path that runs
  uint32_t gone_ = 0;           // entries of the kind Gone
  bool has_switched_ = false, has_yielded_ = false;
};

}  // namespace glint::exec
