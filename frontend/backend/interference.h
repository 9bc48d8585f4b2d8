// Tells which virtual registers may not share a physical register, and which would profit from sharing one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "frontend/backend/liveness.h"
#include "frontend/backend/pair_set.h"
#include "frontend/backend/slots.h"

namespace glint::frontend {

// Names the two register files, which are allocated one after the other.
enum class RegisterFile : uint8_t { Predicates, Registers };

inline RegisterFile file_of(RegisterClass c) {
  return c == RegisterClass::Predicate ? RegisterFile::Predicates : RegisterFile::Registers;
}

// Holds a wish: if slot(of) == slot(other) + offset, an instruction of that weight disappears.
struct SlotWish {
  VirtualRegister other = kNoRegister;
  int offset = 0;
  float weight = 0;
};

// Says which moves are removed by giving both ends one register.
enum class Coalescing : uint8_t {
  // Removes every move without interference. This leaves the fewest moves, but merged values may need spills.
  All,
  // Removes only moves whose merged value is sure to find a register (P. Briggs, "Improvements to graph
  // coloring", 1994).
  Safe,
};

// Holds the interference graph of one register file. After coalescing, a merged group is known by its
// representative.
class InterferenceGraph {
 public:
  InterferenceGraph(const VirtualProgram& program, const Liveness& liveness, const Ops& ops,
                    RegisterFile file, const std::vector<float>& weights)
      : InterferenceGraph(program, liveness, ops, file, weights, nullptr) {}
  // Leaves out the registers that `only` does not have.
  InterferenceGraph(const VirtualProgram& program, const Liveness& liveness, const Ops& ops,
                    RegisterFile file, const std::vector<float>& weights, const std::vector<bool>* only);

  // Merges the ends of moves, the most executed moves first. A `pinned` register must not spill. It merges
  // only with another pinned register, so that no long-lived value becomes pinned.
  void coalesce(Coalescing how, uint32_t max_registers, const std::vector<bool>& pinned);

  bool has(VirtualRegister r) const { return node_of_[r] != kNoRegister; }
  VirtualRegister representative(VirtualRegister r) const;
  bool interfere(VirtualRegister a, VirtualRegister b) const;  // of two representatives
  const std::vector<VirtualRegister>& nodes() const { return nodes_; }
  // Returns the representatives that interfere with representative `r`. The list may hold names that were
  // merged away. representative() maps them to their group; the result may then have duplicates.
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

  const std::vector<RegisterClass>& classes_;
  std::vector<uint32_t> node_of_;  // dense index of each virtual register; kNoRegister: other file
  std::vector<VirtualRegister> nodes_;
  PairSet edges_;  // over dense indices
  std::vector<std::vector<VirtualRegister>> neighbours_;
  std::vector<std::vector<SlotWish>> wishes_;
  mutable std::vector<VirtualRegister> parent_;  // union-find
  mutable std::vector<uint64_t> visited_;        // number of the last search that saw the register
  mutable uint64_t visit_ = 0;
  std::vector<Move> moves_;
};

// Return how many slots a neighbour takes at worst from a value of class `self`, and how many slots there
// are.
uint32_t blocked_by(RegisterClass self, RegisterClass neighbour);
uint32_t slots_for(RegisterClass self, uint32_t max_registers);

}  // namespace glint::frontend
