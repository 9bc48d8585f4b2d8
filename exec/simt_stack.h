// Implements the SIMT stack: which lanes of a warp run now, which wait, and where they meet again.
//
// Entries are of three kinds:
//  - Path: lanes that will run from `pc` later.
//  - Join: lanes that have arrived at the reconvergence point `pc` (a `join` instruction) and wait for the
//    rest.
//  - Call: lanes that have returned from a call and wait for the rest; they resume at `pc`.
// When the running lanes are used up, the top entry is taken: a Path runs, and a Join or Call whose lanes
// have all arrived resumes them. Because lanes arrive at any enclosing Join, not only at the innermost,
// break, continue and early exits out of several constructs need no special case.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"

namespace glint::exec {

class SimtStack {
 public:
  enum class Kind : uint8_t { Path, Join, Call };
  struct Entry {
    Kind kind;
    uint32_t pc;
    LaneMask lanes;
    uint32_t depth = 0;         // Call: trace depth to return to
    uint32_t shader = 0;        // Call: the caller's shader
    uint32_t callables = 0;     // Call: callable depth to return to
    bool is_function = false;   // Call: of a function of the same shader, not of another shader
    bool is_traversal = false;  // Call: of the program that walks rays
  };

  uint32_t pc = 0;
  LaneMask active = 0;

  void start(uint32_t entry_pc, LaneMask lanes) {
    entries_.clear();
    pc = entry_pc;
    active = lanes;
  }
  bool finished() const { return active == 0; }

  void push_reconvergence(uint32_t join_pc) { entries_.push_back({Kind::Join, join_pc, 0}); }
  void push_path(uint32_t path_pc, LaneMask lanes) { entries_.push_back({Kind::Path, path_pc, lanes}); }
  void push_call(uint32_t return_pc, LaneMask arrived, uint32_t depth, uint32_t shader,
                 uint32_t callables = 0, bool is_function = false) {
    entries_.push_back({Kind::Call, return_pc, arrived, depth, shader, callables, is_function});
  }

  // Notes that the call pushed last is of the program that walks rays.
  void mark_traversal() { entries_.back().is_traversal = true; }

  // Lets lanes that reach the join at `join_pc` wait in its entry. The caller then removes them from the
  // running set. Returns false when no enclosing ssy names the place, which is a malformed program.
  bool arrive(uint32_t join_pc, LaneMask lanes) {
    for (size_t i = entries_.size(); i-- > 0;) {
      if (entries_[i].kind == Kind::Call) return false;
      if (entries_[i].kind == Kind::Join && entries_[i].pc == join_pc) {
        entries_[i].lanes |= lanes;
        return true;
      }
    }
    return false;
  }
  // Returns the innermost call, of a shader or of either kind, or null when nobody called.
  const Entry* innermost_call(bool of_shader) const {
    for (size_t i = entries_.size(); i-- > 0;)
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

  // Takes entries while no lanes run, until some run or the stack is empty. When a Call entry resumed, it
  // returns true and puts the entry into *resumed_call.
  bool resume_next(Entry* resumed_call) {
    bool resumed = false;
    while (active == 0 && !entries_.empty()) {
      const Entry top = entries_.back();
      entries_.pop_back();
      active = top.lanes;
      pc = top.kind == Kind::Join ? top.pc + 1 : top.pc;
      if (top.kind == Kind::Call) {  // Even with no lanes left, its context is the caller's again.
        *resumed_call = top;
        resumed = true;
      }
    }
    return resumed;
  }

  size_t depth() const { return entries_.size(); }
  const std::vector<Entry>& entries() const { return entries_; }
  // Returns the lanes of entry `index`, for who moves threads to lanes of other warps.
  LaneMask& lanes_at(size_t index) { return entries_[index].lanes; }

 private:
  std::vector<Entry> entries_;  // It grows once to the program's nesting, then allocates nothing.
};

}  // namespace glint::exec
