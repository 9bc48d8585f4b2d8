// Executes instructions of a warp: the one place where an Effect meets memory, control flow and rays. Both
// machines use it, so their results cannot differ; the timing machine adds only when.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "base/probe.h"
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
  // Texture ops read the four texels of texels(); for surface ops address[lane] is the texel's. Shader calls:
  // address[lane] is the binding-table record of each lane that called, `lanes` those lanes.
  bool finished = false;   // the warp has ended
};

// One instruction that a warp has executed, for whoever listens: co-simulation, traces.
struct Retired {
  const WarpContext& warp;  // its registers after the instruction
  const Issued& issued;
};

class Executor {
 public:
  Probe<Retired> retired;

  explicit Executor(const World& world);

  // Puts warp `warp_index` of the launch into `warp`, at the entry of the ray generation (or compute) shader.
  void start(WarpContext& warp, uint32_t warp_index) const;
  uint32_t num_warps() const;

  // The instruction that execute() would run next.
  const isa::Inst& next(const WarpContext& warp) const { return world_.image->code[warp.simt.pc]; }
  const isa::OpRow& next_row(const WarpContext& warp) const { return *world_.image->rows[warp.simt.pc]; }

  // Runs one instruction to its end, but rt.trace, rt.resume and rq.proceed: those leave `warp.waiting_for_rays` set, the
  // machine traverses warp.rays[lane] for the lanes that are Traversing, then calls finish_rays.
  Issued execute(WarpContext& warp, Cycle now);
  // Writes the answer predicate of the waiting rt.trace or rt.resume.
  void finish_rays(WarpContext& warp) const;

  // Set when an execute() faulted; the warp is left as it was before the instruction.
  const std::optional<Fault>& fault() const { return fault_; }

  // Four texel addresses (virtual) a lane of the last texture op; fewer distinct at borders.
  const std::array<std::array<Address, kLanes>, 4>& texels() const { return texels_; }

  const World& world() const { return world_; }

 private:
  // Each runs one family of effects and moves the pc; false after a fault (executor_memory.cpp and so on).
  bool run_memory(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_image(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_rays(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_control(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

  bool load_global(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool store_global(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool access_local(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, bool store);
  bool load_constant(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool sample(WarpContext& warp, const isa::Inst& inst);
  bool access_surface(WarpContext& warp, const isa::Inst& inst, bool store);
  bool trace(WarpContext& warp, const isa::Inst& inst);
  bool report(WarpContext& warp, const isa::Inst& inst);
  bool run_query(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  rt::RayState* find_query(WarpContext& warp, isa::Slot operand);
  bool begin_queries(WarpContext& warp, const isa::Inst& inst, rt::RayState* states);
  void decide_queries(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, rt::RayState* states);
  bool call(WarpContext& warp, isa::Effect effect);
  bool call_targets(WarpContext& warp, isa::Effect effect, std::array<uint32_t, kLanes>& target);
  const HitGroup* hit_group(const rt::Ray& ray, const rt::Hit& hit, uint32_t& record) const;
  void finish_shader(WarpContext& warp, isa::Effect effect);
  void leave(WarpContext& warp, LaneMask lanes);
  void resume_if_empty(WarpContext& warp);
  void fill_specials(WarpContext& warp, LaneMask lanes, const Shader& shader) const;
  bool fail(WarpContext& warp, int lane, std::string what);

  const World& world_;
  const bool reads_clock_;  // any shader does: its row is filled before each instruction
  std::optional<Fault> fault_;
  std::array<std::array<Address, kLanes>, 4> texels_{};
};

// The fault of a warp that has run for longer than any real one, at the instruction `pc`.
Fault no_end_in_sight(const World& world, const WarpContext& warp, uint32_t pc, uint64_t instruction_budget);

// Launch coordinates of a lane of a warp: x runs fastest.
std::array<uint32_t, 3> launch_id(const World& world, uint32_t warp_index, int lane);

}  // namespace glint::core
