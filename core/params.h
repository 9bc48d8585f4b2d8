// Tunables of a core: warps, schedulers, execution units, load-store unit, launch.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

#include "base/diagnostics.h"
#include "base/params.h"
#include "base/registry.h"
#include "base/types.h"
#include "core/code_params.h"
#include "core/issue_scheduler.h"
#include "core/op_times.h"
#include "exec/warp_layout.h"
#include "isa/op_row.h"

namespace glint::core {

inline constexpr uint32_t kMaxWarps = 64;  // resident warps of a core (GA100, GH100)
inline constexpr uint32_t kMaxSchedulers = 8;
inline constexpr uint32_t kMaxRegisterBanks = 8;
inline constexpr uint32_t kRegisterUnit =
    8;  // registers of a lane are given out in eights (CUDA occupancy tables)

struct UnitParams {
  uint32_t latency = 4;   // from issue to the first cycle in which a dependent instruction can issue
  uint32_t interval = 2;  // from issue to the next issue on the same pipe of the same scheduler
  static constexpr auto params() {
    return std::tuple{
        param(&UnitParams::latency, "latency", "cycle", "Issue to issue of a dependent instruction.", 1,
              1000),
        param(&UnitParams::interval, "interval", "cycle", "Issue to the next issue on this pipe.", 1, 1000)};
  }
};

// Defaults: Accel-Sim's tested RTX 2060 (SM75) configuration unless noted; the divisions are Vulkan-Sim's PTX
// table, because ours are single instructions too.
struct Units {
  UnitParams integer{4, 2}, int_div{145, 8}, fp32{4, 2}, fp_div{39, 4}, fp64{64, 64}, fp64_div{330, 130},
      fp16{4, 2}, sfu{21, 8};
  UnitParams move{4, 2}, predicate{4, 2};
  // Latency up to the L1's door: 12 + 20 of the L1 is the measured load-to-use 32 (RTX A6000, MICRO 2025,
  // table 2). Interval: one address-generation unit a scheduler, one instruction in 4 cycles (same paper,
  // section 5.4).
  UnitParams lsu{12, 4};
  UnitParams constant{26, 2};  // constant-cache hit of a T4: 26 cycles (Jia et al. 2019, table 3.1)
  UnitParams tex{180, 4};      // 200 in all with the L1 hit in it
  UnitParams shuffle{26, 4};   // shfl.bfly of an H200: 26 cycles, a warp in 4 a sub-core
  UnitParams branch{4, 2};
  UnitParams barrier{13, 2};  // bar.sync of an H200: 12.75 cycles and 2 a warp
  UnitParams rt_unit{4, 4};   // handing over rays; charged on the way back
  static constexpr auto params() {
    return std::tuple{
        section(&Units::integer, "int", "Integer arithmetic and logic."),
        section(&Units::int_div, "int_div", "Integer division, on the special-function pipe."),
        section(&Units::fp32, "fp32", "Single precision."),
        section(&Units::fp_div, "fp_div", "Division, on the special-function pipe."),
        section(&Units::fp64, "fp64", "Double precision."),
        section(&Units::fp64_div, "fp64_div", "Double-precision division and roots."),
        section(&Units::fp16, "fp16", "Floats of 16 bits, on the single-precision pipe."),
        section(&Units::sfu, "sfu", "Transcendentals and roots."),
        section(&Units::move, "move", "Moves and selections, on the integer pipe."),
        section(&Units::predicate, "predicate", "Comparisons and predicate logic, on the integer pipe."),
        section(&Units::shuffle, "shuffle", "Shuffles, votes, matches and reductions across lanes."),
        section(&Units::lsu, "lsu", "Address generation: latency up to the L1, interval a scheduler."),
        section(&Units::constant, "const", "Constant loads."),
        section(&Units::tex, "tex", "Texture and image unit: latency up to the L1, interval a core."),
        section(&Units::branch, "branch", "Branches, calls, returns: the warp waits for the latency."),
        section(&Units::barrier, "barrier", "Barriers and fences: the warp waits for the latency at least."),
        section(&Units::rt_unit, "rt_unit", "Ray instructions; the latency follows the RT unit's answer.")};
  }
  std::array<UnitParams, size_t(isa::Unit::Count)> by_unit() const {  // in the order of isa::Unit
    return {integer,   int_div, fp32, fp_div,   fp64, fp64_div, fp16,    sfu,    move,
            predicate, shuffle, lsu,  constant, tex,  branch,   barrier, rt_unit};
  }
};

// Defaults: RTX A6000, MICRO 2025 ("Analyzing Modern NVIDIA GPU cores"), sections 5.3 and 5.4.
struct LsuParams {
  uint32_t queue = 5;  // 4 entries and a latch: 5 back to back
  uint32_t accept_interval = 2;
  uint32_t sectors_per_cycle = 2;  // 512 bits a cycle between L1 and registers
  uint32_t accesses = 128;         // Choice: unpublished; 4 a resident warp at 32 warps
  // An H200 looks up 4 lines a cycle, and reads as many words of a bank as an access wants there, one after
  // another.
  uint32_t lines_per_cycle = 1;  // Volta and later: one line of 128 B a cycle
  bool bank_conflicts = false;
  // Same paper, table 2: the registers of a load may be overwritten 11 cycles after it, of one from shared
  // memory 9.
  uint32_t war_latency = 11, shared_war_latency = 9;
  uint32_t atomic_latency = 0;  // an H200: 204; 0: what other parts take is unpublished
  bool atomic_turns = false;    // an H200: true; as unpublished of others
  bool holds_operands() const { return war_latency + shared_war_latency > 0; }
  static constexpr auto params() {
    return std::tuple{
        param(&LsuParams::queue, "queue", "instruction",
              "Memory instructions that wait in each scheduler's queue.", 1, 16),
        param(&LsuParams::accept_interval, "accept_interval", "cycle",
              "The core's unit takes one warp instruction in so many.", 1, 64),
        param(&LsuParams::sectors_per_cycle, "sectors_per_cycle", "sector",
              "32 B sectors asked of the L1 a cycle.", 1, 4),
        param(&LsuParams::accesses, "accesses", "instruction",
              "Memory instructions of a core between issue and completion.", 1, 1024),
        param(&LsuParams::lines_per_cycle, "lines_per_cycle", "line",
              "Lines of one access asked of the L1 in the same cycle.", 1, 32),
        flag(&LsuParams::bank_conflicts, "bank_conflicts",
             "An access to global memory takes a cycle for each different word in the fullest of 32 banks of "
             "4 bytes."),
        param(&LsuParams::war_latency, "war_latency", "cycle",
              "From a memory instruction to the first that may overwrite its sources, if it does not wait in "
              "its queue; 0: they are read at issue.",
              0, 1000),
        param(&LsuParams::shared_war_latency, "shared_war_latency", "cycle", "The same of shared memory.", 0,
              1000),
        param(&LsuParams::atomic_latency, "atomic_latency", "cycle",
              "Longer than a load that an atomic on global memory takes to its registers.", 0, 10000),
        flag(&LsuParams::atomic_turns, "atomic_turns",
             "Lanes of an atomic that meet in a word of global memory take turns there; otherwise each "
             "sector has one turn.")};
  }
};

// Defaults: Turing: four texture units a core, each one bilinear sample a cycle (Turing whitepaper, 2018,
// TU102: 288 units in 72 cores). Queue and door of its own: Choice, as MICRO 2025 draws the unit; its depth
// is not published.
struct TextureParams {
  uint32_t samples_per_cycle = 4;
  uint32_t queue = 5;
  bool own_door = true;
  static constexpr auto params() {
    return std::tuple{
        param(&TextureParams::samples_per_cycle, "samples_per_cycle", "sample",
              "Samples of up to four texels a cycle and core; 0: the unit's interval alone limits it.", 0,
              128),
        param(
            &TextureParams::queue, "queue", "instruction",
            "Texture and image instructions that wait in a queue of each scheduler; 0: in the one of loads.",
            0, 16),
        flag(&TextureParams::own_door, "own_door",
             "Texels and loads are asked of the L1 in the same cycle, its ports permitting.")};
  }
};

// Defaults: MICRO 2025, section 5.3: two banks a sub-core with a port each, read within three cycles; off
// because an ideal register file predicts as well there. Model: no cache of operands; memory instructions
// read when the ports are free.
struct RegisterFileParams {
  uint32_t banks = 0, window = 3;
  static constexpr auto params() {
    return std::tuple{
        param(&RegisterFileParams::banks, "banks", "bank",
              "Banks of a scheduler's registers, register r in bank r mod this; 0: no conflicts.", 0,
              kMaxRegisterBanks),
        param(&RegisterFileParams::window, "window", "cycle",
              "In which an instruction of fixed latency reads its registers, one a bank and cycle.", 1, 16)};
  }
};

// Of atomics, by what shared memory takes for them.
enum class AtomicKind : uint8_t { Integer, Swap, FloatAdd };

// Times of atomics that take others than an addition of integers.
struct AtomicParams {
  uint32_t latency = 0, pass = 0, hidden = 0;
  static constexpr auto params() {
    return std::tuple{
        param(&AtomicParams::latency, "latency", "cycle",
              "One lane, issue to dependent issue; 0: all times as those of atomic_latency.", 0, 10000),
        param(&AtomicParams::pass, "pass", "cycle",
              "Latency of each further turn of lanes that meet in a bank.", 0, 1000),
        param(&AtomicParams::hidden, "hidden", "cycle",
              "Of that, in all, what the latency of one lane hides.", 0, 1000)};
  }
};

// Defaults: microbenchmarks of an H200, but for conflicts: there, n lanes in a bank take n cycles of the unit
// and 2n - 5 more of latency (a turn 2, hidden 3).
struct SharedParams {
  uint32_t latency = 23;         // dependent loads
  uint32_t atomic_latency = 76;  // dependent atom.shared.add.u32; 126 when 32 lanes meet in a word
  uint32_t atomic_pass = 2, atomic_hidden = 0;
  AtomicParams swap, float_add;
  uint32_t conflict_turn = 1, conflict_hidden = 0;
  static constexpr auto params() {
    return std::tuple{
        param(&SharedParams::latency, "latency", "cycle",
              "A load without bank conflicts, issue to dependent issue.", 1, 1000),
        param(&SharedParams::atomic_latency, "atomic_latency", "cycle", "The same of an atomic.", 1, 1000),
        param(&SharedParams::atomic_pass, "atomic_pass", "cycle",
              "Each further turn of lanes that meet in a bank, for an atomic.", 1, 100),
        param(&SharedParams::atomic_hidden, "atomic_hidden", "cycle",
              "Of those turns' latency, in all, what the latency of an atomic alone hides.", 0, 100),
        section(&SharedParams::swap, "swap", "Compare-and-swap."),
        section(&SharedParams::float_add, "float_add",
                "Floating-point addition: hardware loops over compare-and-swap."),
        param(&SharedParams::conflict_turn, "conflict_turn", "cycle",
              "Latency of each further turn of a load, also of global memory.", 0, 100),
        param(&SharedParams::conflict_hidden, "conflict_hidden", "cycle",
              "Of that, in all, what the latency without conflicts hides.", 0, 100)};
  }
};

// Defaults: an H200, without stores before. Model: no acknowledgement travels: a fence waits until the warp's
// accesses have been answered or taken by the L1, whose queue keeps their order, and then for this time.
struct FenceParams {
  uint32_t block = 36, gpu = 289, system = 1055;
  uint32_t acknowledgement = 0;  // an H200: 286; 0: stores are done when they have left their core
  static constexpr auto params() {
    return std::tuple{
        param(&FenceParams::block, "block", "cycle", "membar.cta, after the warp's last access.", 1, 60000),
        param(&FenceParams::gpu, "gpu", "cycle", "membar.gl, after the warp's last access.", 1, 60000),
        param(&FenceParams::system, "system", "cycle", "membar.sys, after the warp's last access.", 1, 60000),
        param(&FenceParams::acknowledgement, "acknowledgement", "cycle",
              "Longer that membar.gl takes behind a store to global memory.", 0, 60000)};
  }
};

// Instructions that hardware executes before a kernel's own. An H200 has 2 (stack pointer and descriptor of
// global memory, read from constants) and 3 more in kernels with shared memory (where its window lies): so
// the executed instructions of five kernels of 19 to 155 come out exactly. 0 here: shaders of other parts
// have what they need in their code.
struct PrologueParams {
  uint32_t instructions = 0, shared_instructions = 0;
  static constexpr auto params() {
    return std::tuple{param(&PrologueParams::instructions, "instructions", "instruction",
                            "Issue slots of each warp before its first instruction.", 0, 1000),
                      param(&PrologueParams::shared_instructions, "shared_instructions", "instruction",
                            "More of them where the launch has shared memory.", 0, 1000)};
  }
};

struct Params {
  uint32_t warps = 32;
  uint32_t schedulers = 4;
  uint32_t registers = 32768;
  uint32_t blocks = 16;           // Turing and GA10x (CUDA programming guide, compute capability 7.5 and 8.6)
  uint32_t shared_bytes = 65536;  // Turing: up to 64 KiB of the 96 KiB that it shares with the L1
  PolicyChoice<IssueScheduler> issue{"gto"};
  PolicyChoice<OpTimes> op_times{"by_unit"};
  Units units;
  // An H200: 1 (4 cycles within a pipe, 5 to another; 17 and 18 from the special-function unit) and 9 (a
  // comparison's result selects after 4 cycles and guards after 13). 0 here: the latencies of other parts
  // have these in them.
  uint32_t pipe_crossing = 0, guard_delay = 0;
  // Results of fixed latency are written in the order of their ends: nothing checks them (MICRO 2025,
  // section 4.1).
  bool write_order = false;
  bool dispatch_latch = false;
  RegisterFileParams register_file;
  FetchParams fetch;
  ConstantParams constant;
  CodeCacheParams code_cache;
  LsuParams lsu;
  TextureParams texture;
  SharedParams shared;
  FenceParams fence;
  PrologueParams prologue;
  bool ends_when_written =
      false;  // hardware: true; false: the launch ends when its last write has left its core
  uint32_t launch_latency = 5000;  // Vulkan-Sim, -gpgpu_kernel_launch_latency
  uint32_t warp_launch_latency = 0;
  uint32_t block_interval = 1;  // GPGPU-Sim and Accel-Sim: a core takes one block a cycle (issue_block2core)
  PolicyChoice<exec::WarpLayout> layout{"linear"};
  uint64_t instruction_budget = 100'000'000;
  // Choice: 15 ms of a GPU; nothing but warps that spin is known to do so little for so long.
  uint64_t livelock_budget = 20'000'000;
  static constexpr auto params() {
    return std::tuple{
        param(&Params::warps, "warps", "warp", "Resident warps of a core, registers permitting.", 1,
              kMaxWarps),
        param(&Params::schedulers, "schedulers", "scheduler",
              "Schedulers of a core; warp slot w belongs to scheduler w mod this.", 1, kMaxSchedulers),
        param(&Params::registers, "registers", "register", "32-bit registers of a core.", 256, 1 << 20),
        param(&Params::blocks, "blocks", "block",
              "Resident blocks of a core; launches without blocks do not count.", 1, kMaxWarps),
        param(&Params::shared_bytes, "shared_bytes", "byte", "Shared memory of a core.", 0, 1 << 20),
        policy(&Params::issue, "issue", "Which ready warp a scheduler issues from."),
        policy(&Params::op_times, "op_times", "Times of single ops, where they are not those of their unit."),
        section(&Params::units, "units", "Latency and initiation interval of the execution units."),
        param(&Params::pipe_crossing, "pipe_crossing", "cycle",
              "Later that a result reaches another pipe than its own.", 0, 100),
        param(&Params::guard_delay, "guard_delay", "cycle",
              "Later that a predicate guards an instruction than it can be read.", 0, 100),
        flag(&Params::write_order, "write_order",
             "A result waits for earlier ones of its register, also where it would end after them anyway."),
        flag(&Params::dispatch_latch, "dispatch_latch",
             "An instruction may issue to a busy pipe and wait in front of it, one a pipe; otherwise warps "
             "issue to free pipes only."),
        section(&Params::register_file, "register_file", "Register-file banks."),
        section(&Params::fetch, "fetch", "Instruction caches of the schedulers."),
        section(&Params::constant, "constant", "Constant cache."),
        section(&Params::code_cache, "code_cache", "Cache behind both."),
        section(&Params::lsu, "lsu", "Load-store unit."),
        section(&Params::texture, "texture", "Texture unit."),
        section(&Params::shared, "shared", "Shared memory: 32 banks of 4 bytes."),
        section(&Params::fence, "fence", "Memory fences."),
        section(&Params::prologue, "prologue", "What each warp executes before its first instruction."),
        param(&Params::launch_latency, "launch_latency", "cycle", "From the launch to the first instruction.",
              0, 1'000'000),
        flag(&Params::ends_when_written, "ends_when_written",
             "The launch ends when its last write is in the L2, not when it has left its core."),
        param(&Params::warp_launch_latency, "warp_launch_latency", "cycle",
              "From taking a warp slot to the first instruction.", 0, 100'000),
        param(&Params::block_interval, "block_interval", "cycle", "Between two blocks that start on a core.",
              0, 10'000),
        policy(&Params::layout, "warp_layout",
               "Which threads of a launch form a warp, and the order in which warps and blocks start."),
        param(&Params::instruction_budget, "instruction_budget", "instruction",
              "Instructions after which a warp is held to have no end.", 1, uint64_t{1} << 40),
        param(&Params::livelock_budget, "livelock_budget", "cycle",
              "After so long in which no warp and no ray has ended and nothing in memory has changed, the "
              "machine is held to spin for ever; 0: never.",
              0, uint64_t{1} << 40)};
  }
};

// Warps that fit when each lane holds `num_registers` registers; 0 when not even one does.
uint32_t occupancy(const Params& params, uint32_t num_registers);

// What a launch asks of a core, and what of it fits there at a time.
struct LaunchNeeds {
  uint32_t registers = 1;     // a lane
  uint32_t warps = 1;         // a block; 1 without blocks
  uint32_t shared_bytes = 0;  // a block
  bool has_blocks = false;
};
struct Residency {
  // Which of a core's resources is used up first; in this order when several are.
  enum class Limit : uint8_t { Warps, Registers, Blocks, SharedMemory } limit = Limit::Warps;
  uint32_t blocks = 0, warps = 0;
};
std::string_view name_of(Residency::Limit limit);
Residency residency(const Params& params, const LaunchNeeds& needs);

// Reports a program that cannot run on such a core, or a block that does not fit.
void check(const Params& params, uint32_t num_registers, Diagnostics& diagnostics);
void check_block(const Params& params, uint32_t num_registers, uint64_t threads, uint32_t shared_bytes,
                 Diagnostics& diagnostics);

}  // namespace glint::core
