// Which virtual registers may not share a physical one, and which would like to.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frontend/backend/liveness.h"
#include "frontend/backend/slots.h"

namespace glint::frontend {

// The two register files that are allocated one after the other.
enum class RegisterFile : uint8_t { Predicates, Registers };

inline RegisterFile file_of(RegisterClass c) {
  return c == RegisterClass::Predicate ? RegisterFile::Predicates : RegisterFile::Registers;
}

// A wish: slot(of) == slot(other) + offset makes an instruction of that weight disappear.
struct SlotWish {
  VirtualRegister other = kNoRegister;
  int offset = 0;
  float weight = 0;
};

// How moves are removed by giving both ends one register.
enum class Coalescing : uint8_t {
  All,   // whatever does not interfere: fewest moves, but the merged values may need spills
  Safe,  // only when the merged value is sure to find a register (P. Briggs, "Improvements to graph
         // coloring", 1994)
};

// Interference graph of one register file. After coalescing, a merged group is known by its representative.
class InterferenceGraph {
 public:
  InterferenceGraph(const VirtualProgram& program, const Liveness& liveness, const Ops& ops,
                    RegisterFile file, const std::vector<float>& weights);

  // Merges the ends of moves, most executed first. A `pinned` register (one that must not spill) merges only
  // with another: a long-lived value must not become pinned.
  void coalesce(Coalescing how, uint32_t max_registers, const std::vector<bool>& pinned);

  bool has(VirtualRegister r) const { return node_of_[r] != kNoRegister; }
  VirtualRegister representative(VirtualRegister r) const;
  bool interfere(VirtualRegister a, VirtualRegister b) const;  // of two representatives
  const std::vector<VirtualRegister>& nodes() const { return nodes_; }
  // Representatives that interfere with representative `r`. May hold names that have been merged away: map
  // them with representative(), duplicates are possible then.
  const std::vector<VirtualRegister>& neighbours(VirtualRegister r) const { return neighbours_[r]; }
  const std::vector<SlotWish>& wishes(VirtualRegister r) const { return wishes_[r]; }

 private:
  struct Move {
    VirtualRegister to, from;
    float weight;
  };
  void scan_block(const VirtualProgram& program, const RegisterSet& live_out, const Ops& ops, BlockId block,
                  float weight);
  void add_edge(VirtualRegister a, VirtualRegister b);
  void add_edges(const VirtualInst& inst, const RegisterSet& live, VirtualRegister exempt);
  void note_wishes(const VirtualInst& inst, const Ops& ops, float weight);
  void wish(VirtualRegister a, VirtualRegister b, int offset, float weight);
  bool safe_to_merge(VirtualRegister a, VirtualRegister b, uint32_t max_registers) const;
  void merge(VirtualRegister into, VirtualRegister gone);
  size_t bit_of(VirtualRegister a, VirtualRegister b) const;

  const std::vector<RegisterClass>& classes_;
  std::vector<uint32_t> node_of_;  // dense index a virtual register, kNoRegister: other file
  std::vector<VirtualRegister> nodes_;
  std::vector<uint64_t> matrix_;  // lower triangle over dense indices
  std::vector<std::vector<VirtualRegister>> neighbours_;
  std::vector<std::vector<SlotWish>> wishes_;
  mutable std::vector<VirtualRegister> parent_;  // union-find
  mutable std::vector<uint64_t> visited_;        // the search that saw a register last
  mutable uint64_t visit_ = 0;
  std::vector<Move> moves_;
};

// Slots that a neighbour takes from the view of a value of class `self`, at worst; and how many there are.
uint32_t blocked_by(RegisterClass self, RegisterClass neighbour);
uint32_t slots_for(RegisterClass self, uint32_t max_registers);

}  // namespace glint::frontend
