// Executes instructions of a warp: the one place where an Effect meets memory, control flow and rays. Both
// machines use it, so their results cannot differ; the timing machine adds only when.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "core/image.h"
#include "core/warp_context.h"
#include "isa/op_row.h"

namespace glint::core {

// A mistake of the simulated program. The warp stops at once; the machine reports it.
struct Fault {
  std::string what;       // "reads 4 bytes 16 bytes past the end of 'binding 4 (Vertices)'"
  std::string place;      // shader, GLSL file and line, instruction
  std::array<uint32_t, 3> launch_id{};
  std::string to_string() const;
};

// What one executed instruction did, for the timing machine: everything a unit needs to charge for it.
struct Issued {
  uint32_t pc = 0;
  const isa::Inst* inst = nullptr;
  const isa::OpRow* row = nullptr;
  LaneMask lanes = 0;      // that executed it (active and guard)
  LaneMask active = 0;     // that were running
  // Loads, stores, texture and surface ops: the addresses are in warp.regs.access until the next execute().
  // Texture: the executor has replaced address[lane] by the first of four texel addresses, see `texels`.
  bool finished = false;   // the warp has ended
};

class Executor {
 public:
  explicit Executor(const World& world);

  // Puts warp `warp_index` of the launch into `warp`, at the entry of the ray generation (or compute) shader.
  void start(WarpContext& warp, uint32_t warp_index) const;
  uint32_t num_warps() const;

  // The instruction that execute() would run next.
  const isa::Inst& next(const WarpContext& warp) const { return world_.image->code[warp.simt.pc]; }
  const isa::OpRow& next_row(const WarpContext& warp) const { return *world_.image->rows[warp.simt.pc]; }

  // Runs one instruction to its end, but rt.trace and rt.resume: those leave `warp.waiting_for_rays` set, the
  // machine traverses warp.frame().ray[lane] for the lanes that are Traversing, then calls finish_rays.
  Issued execute(WarpContext& warp, Cycle now);
  // Writes the answer predicate of the waiting rt.trace or rt.resume.
  void finish_rays(WarpContext& warp) const;

  // Set when an execute() faulted; the warp is left as it was before the instruction.
  const std::optional<Fault>& fault() const { return fault_; }

  // Four texel addresses (virtual) a lane of the last texture op; fewer distinct at borders.
  const std::array<std::array<Address, kLanes>, 4>& texels() const { return texels_; }

  const World& world() const { return world_; }

 private:
  const World& world_;
  std::optional<Fault> fault_;
  std::array<std::array<Address, kLanes>, 4> texels_{};
};

}  // namespace glint::core
