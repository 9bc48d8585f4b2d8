// Executes instructions of a warp: the one place where an Effect meets memory, control flow and rays. Both
// machines use it, so their results cannot differ; the timing machine adds only when.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "base/probe.h"
#include "exec/fault.h"
#include "exec/image.h"
#include "exec/memory_view.h"
#include "exec/texel_list.h"
#include "exec/warp_context.h"
#include "isa/op_row.h"
#include "rtunit/any_hit_mode.h"

namespace glint::exec {

// What one executed instruction did, for the timing machine: everything a unit needs to charge for it.
struct Issued {
  uint32_t pc = 0;
  const isa::Inst* inst = nullptr;
  const isa::OpRow* row = nullptr;
  LaneMask lanes = 0;   // that executed it (active and guard)
  LaneMask active = 0;  // that were running
  // Loads, stores, texture and surface ops: the addresses are in warp.regs.access until the next execute().
  // Texture and surface ops touched texels(). Shader calls:
  // address[lane] is the binding-table record of each lane that called, `lanes` those lanes.
  bool finished = false;  // the warp has ended
};

// What intersection and any-hit shaders had to do.
struct CandidateCounts {
  uint64_t calls = 0, lanes = 0;                      // of such shaders: one a warp and shader
  uint64_t gathered = 0, dropped = 0, overflows = 0;  // of ended traces (rtunit/candidate_table.h)
};

// Lanes of a warp that begin a shader because another called it.
struct Called {
  const WarpContext& warp;
  isa::Stage stage;
  LaneMask lanes;
};

// Where a machine has put a warp, as its program may ask: %warpid, %nwarpid, %smid, %nsmid.
struct Seat {
  uint32_t slot = 0, slots = 1;  // of the core
  uint32_t core = 0, cores = 1;
};

// One instruction that a warp has executed, for whoever listens: co-simulation, traces.
struct Retired {
  const WarpContext& warp;  // its registers after the instruction
  const Issued& issued;
};

class Executor {
 public:
  Probe<Retired> retired;
  Probe<Called> called;

  // `clock_mhz` turns cycles into the time that programs read; 0: they read 0.
  explicit Executor(const World& world, double clock_mhz = 0.0);

  uint32_t num_blocks() const;
  uint32_t warps_per_block() const;  // 1 in a launch without blocks
  uint32_t num_warps() const { return num_blocks() * warps_per_block(); }

  // Empties `block` for block `index` of the launch: zeroed shared memory, no warp has arrived anywhere.
  // Blocks are numbered x fastest, if the layout does not say otherwise.
  void start(Block& block, uint32_t index) const;
  // Puts a warp of the block into `warp`, at the entry of the ray generation (or compute) shader. Neither may
  // move until the warp has ended.
  void start(WarpContext& warp, Block& block, uint32_t warp_in_block, const Seat& seat = {}) const;
  // In a launch without blocks: puts warp `warp_index` into `warp`, as a block of its own.
  void start(WarpContext& warp, uint32_t warp_index) const;

  // The instruction that execute() would run next.
  const isa::Inst& next(const WarpContext& warp) const { return world_.image->code[warp.simt.pc]; }
  const isa::OpRow& next_row(const WarpContext& warp) const { return *world_.image->rows[warp.simt.pc]; }

  // Runs one instruction to its end, but rt.trace, rt.resume and rq.proceed: those leave
  // `warp.waiting_for_rays` set, the machine traverses warp.rays[lane] for the lanes that are Traversing,
  // then calls finish_rays. With World::traversal they call its program instead, like a shader, and no lane
  // that waits is Traversing. A bar.* that has to wait leaves `warp.waiting_at_barrier` set: the warp may be
  // executed again when another warp of its block has come or ended, and cleared it.
  Issued execute(WarpContext& warp, Cycle now);
  // Writes the answer predicate of the waiting rt.trace or rt.resume.
  void finish_rays(WarpContext& warp) const;

  // Set when an execute() faulted; the warp is left as it was before the instruction.
  const std::optional<Fault>& fault() const { return fault_; }
  // What went wrong and was let pass, because World::on_fault says so.
  const FaultLog& passed() const { return passed_; }

  const CandidateCounts& candidates() const { return candidates_; }
  // Lanes that have begun a shader of the stage because another called it.
  uint64_t called_lanes(isa::Stage stage) const { return called_lanes_[size_t(stage)]; }

  // Of the last texture or surface op; empty when it needed no memory.
  const TexelList& texels() const { return texels_; }

  // Of the last load, store or atomic: the lanes whose access went to that space. Their Access::address is
  // then an address of the space, of generic accesses too. Without lanes whose access was let pass and went
  // nowhere.
  LaneMask lanes_in(isa::Space space) const { return lanes_in_[size_t(space)]; }

  // Global memory is reached through `view` from now on; without one, effects on it happen at once.
  void use(MemoryView* view) { view_ = view; }
  // Whether the last load or atomic writes its registers only when the view is committed.
  bool is_late() const { return is_late_; }
  // Grows with every store outside of a view and every atomic there that has changed something: shared
  // memory, mostly.
  uint64_t changes() const { return changes_; }

  const World& world() const { return world_; }

 private:
  // Each runs one family of effects and moves the pc; false after a fault (executor_memory.cpp and so on).
  bool run_memory(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_image(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_rays(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_control(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

  bool run_print(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_barrier(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool branch(WarpContext& warp, uint32_t target);
  bool branch_indexed(WarpContext& warp, const isa::Inst& inst);
  bool call_function(WarpContext& warp, uint32_t target);
  bool return_from(WarpContext& warp, isa::Effect effect);
  bool end_warp(WarpContext& warp);
  bool check_barrier(WarpContext& warp, uint32_t barrier, uint32_t threads);
  void open_barrier(Block& block, uint32_t barrier);
  bool fail_stuck(const Block& block);

  bool access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes);
  bool locate(WarpContext& warp, const isa::OpRow& row, isa::Space space, LaneMask& lanes,
              std::array<std::byte*, kLanes>& at);
  bool move_data(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
                 LaneMask lanes);
  bool modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes);
  // The same of global memory seen through view_ (executor_view.cpp). `at`: where each of the lanes' data
  // lies.
  using Places = std::array<std::byte*, kLanes>;
  void load_seen(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
                 const Places& at);
  void store_seen(const WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
                  const Places& at);
  void surface_seen(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, const Places& place);
  void modify_seen(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
                   const Places& at);
  bool access_local(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);
  bool refuse(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes, const std::string& why);
  bool check_local(WarpContext& warp, const isa::OpRow& row, LaneMask& lanes);
  bool load_constant(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
                     LaneMask lanes);
  bool texture(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool query_image(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool surface(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  const ImageView* find_image(WarpContext& warp, const isa::OpRow& row, int lane);
  const Sampler& find_sampler(const ImageView& image, Address handle) const;
  std::byte* find_texel(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, int lane);
  bool trace(WarpContext& warp, const isa::Inst& inst);
  bool report(WarpContext& warp, const isa::Inst& inst);
  bool call_callable(WarpContext& warp, const isa::Inst& inst);
  // Number of shaders called.
  uint32_t call_by_shader(WarpContext& warp, const std::array<uint32_t, kLanes>& target, LaneMask callers,
                          bool is_callable);
  // The objects, one a lane, that the executing lanes name alike; null after a fault. `what`: in its message.
  template <class Object>
  Object* find_numbered(WarpContext& warp, Numbered<Object>& objects, isa::Slot operand, uint32_t level,
                        std::string_view what) {
    const std::optional<uint32_t> number = shared_number(warp, operand, what);
    if (!number) return nullptr;
    const size_t place = size_t(level) * kMaxNumbered + *number;
    if (objects.size() <= place) objects.resize(place + 1);
    if (!objects[place]) objects[place] = std::make_unique<std::array<Object, kLanes>>();
    return objects[place]->data();
  }
  std::optional<uint32_t> shared_number(WarpContext& warp, isa::Slot operand, std::string_view what);
  bool run_hit_object(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool run_time(WarpContext& warp, const isa::Inst& inst, bool set);
  bool run_corner(WarpContext& warp, const isa::Inst& inst);
  bool make_hit(WarpContext& warp, const isa::Inst& inst, bool has_stride, int lane, HitObject& object);
  bool open_trace(WarpContext& warp, const isa::Inst& inst, size_t payload_operand);
  bool begin_hit_object(WarpContext& warp, const isa::Inst& inst);
  uint32_t hit_object_value(const HitObject& object, uint32_t value) const;
  bool run_query(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool begin_queries(WarpContext& warp, const isa::Inst& inst, rt::RayState* states);
  void decide_queries(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, rt::RayState* states);
  bool call(WarpContext& warp, isa::Effect effect);
  void walk_in_code(WarpContext& warp, uint32_t pc);
  void take_walked_rays(WarpContext& warp);
  uint32_t record_of_rays(const WarpContext& warp) const;
  rt::CandidateTable* table_of(TraceFrame& frame, int lane) const;
  void present_candidates(WarpContext& warp, LaneMask gathered) const;
  void count_candidates(WarpContext& warp);
  bool call_targets(WarpContext& warp, isa::Effect effect, std::array<uint32_t, kLanes>& target);
  uint32_t hit_record(const rt::Ray& ray, const rt::Hit& hit) const;
  const HitGroup* hit_group(const rt::Ray& ray, const rt::Hit& hit, uint32_t& record) const;
  void finish_shader(WarpContext& warp, isa::Effect effect);
  void leave(WarpContext& warp, LaneMask lanes);
  void resume_if_empty(WarpContext& warp);
  void fill_specials(WarpContext& warp, LaneMask lanes, const Shader& shader) const;
  void fill_ray_specials(WarpContext& warp, int lane, const Shader& shader) const;
  void fill_launch_specials(WarpContext& warp, const Seat& seat) const;
  void fill_clock(WarpContext& warp, Cycle now) const;
  bool fail(WarpContext& warp, int lane, std::string what);
  // False: a fault, as fail(). True: noted, and the lane goes on without effect.
  bool let_pass(WarpContext& warp, int lane, FaultKind kind, const std::function<std::string()>& what);
  // Of a record outside of its region, which then calls nothing; of what is no structure, which then is
  // missed.
  bool let_pass_record(WarpContext& warp, int lane, std::string_view region, uint32_t record, size_t records,
                       const std::string& how = {});
  bool let_pass_hit_record(WarpContext& warp, int lane, const rt::Ray& ray, const rt::Hit& hit);
  void call_nothing(WarpContext& warp, int lane, rt::RayState& state, isa::Effect effect);
  bool let_pass_structure(WarpContext& warp, int lane, std::string_view verb, Address structure);
  bool let_pass_broken(WarpContext& warp, int lane, rt::RayState& state);

  const World& world_;
  const bool reads_clock_;  // any shader does: its rows are filled before each instruction
  const double clock_mhz_;
  const uint32_t table_rows_;  // of the any-hit mode
  CandidateCounts candidates_;
  std::array<uint64_t, size_t(isa::Stage::Compute) + 1> called_lanes_{};
  std::array<LaneMask, size_t(isa::Space::Generic) + 1> lanes_in_{};
  MemoryView* view_ = nullptr;
  uint64_t changes_ = 0;
  bool is_late_ = false;
  std::optional<Fault> fault_;
  FaultLog passed_;
  TexelList texels_;
};

// The fault of a warp that has run for longer than any real one, at the instruction `pc`.
Fault no_end_in_sight(const World& world, const WarpContext& warp, uint32_t pc, uint64_t instruction_budget);

// Launch coordinates of a lane of a warp, as World::layout has them; in a launch with blocks x runs fastest
// within the block. A lane without a thread is outside of the launch.
std::array<uint32_t, 3> launch_id(const World& world, uint32_t warp_index, int lane);
uint32_t warps_per_block(const World& world);

}  // namespace glint::exec
