// Declares the parameters of a core: warps, schedulers, execution units, load-store unit, launch.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "base/params.h"
#include "base/registry.h"
#include "base/types.h"
#include "core/code_params.h"
#include "core/interleaving.h"
#include "core/issue_scheduler.h"
#include "core/op_times.h"
#include "core/parking.h"
#include "core/reorder.h"
#include "core/shared_params.h"
#include "exec/warp_layout.h"
#include "isa/op_row.h"

namespace glint::core {

inline constexpr uint32_t kMaxWarps = 64;  // most resident warps of a core (GA100, GH100)
inline constexpr uint32_t kMaxSchedulers = 8;
inline constexpr uint32_t kMaxRegisterBanks = 8;
// CUDA gives out the registers of a lane in eights (CUDA occupancy tables).
inline constexpr uint32_t kRegisterUnit = 8;

struct UnitParams {
  uint32_t latency = 4;   // cycles from issue to the first cycle in which a dependent instruction can issue
  uint32_t interval = 2;  // cycles from issue to the next issue on the same pipe of the same scheduler
  static ParamList params() {
    return {param(&UnitParams::latency, "latency", "cycle",
                  "Cycles from issue to the issue of a dependent instruction.", 1, 1000),
            param(&UnitParams::interval, "interval", "cycle",
                  "Cycles from issue to the next issue on the same pipe.", 1, 1000)};
  }
};

// Holds the times of the execution units. The defaults are those of Accel-Sim's tested RTX 2060 (SM75)
// configuration unless noted. The divisions are from Vulkan-Sim's PTX table, because ours are single
// instructions too.
struct Units {
  UnitParams integer{4, 2}, int_div{145, 8}, fp32{4, 2}, fp_div{39, 4}, fp64{64, 64}, fp64_div{330, 130},
      fp16{4, 2}, sfu{21, 8};
  UnitParams move{4, 2}, predicate{4, 2};
  // The latency lasts up to the L1's door: 12 + 20 of the L1 is the measured load-to-use 32 (RTX A6000, MICRO
  // 2025, table 2). The interval is that of one address-generation unit per scheduler, which takes one
  // instruction in 4 cycles (same paper, section 5.4).
  UnitParams lsu{12, 4};
  UnitParams constant{26, 2};  // constant-cache hit of a T4: 26 cycles (Jia et al. 2019, table 3.1)
  UnitParams tex{180, 4};      // 200 together with an L1 hit
  UnitParams shuffle{26, 4};   // shfl.bfly of an H200: 26 cycles, and a warp in 4 cycles per sub-core
  // Turing has two tensor cores per sub-core, each with 64 products of halves per cycle (Turing whitepaper,
  // 2018), so that an m16n8k16 takes 16 cycles. Guess: the latency is that interval and as much again.
  // Model: all shapes and types take the times of m16n8k16 where no op has a time of its own.
  UnitParams tensor{32, 16};
  UnitParams branch{4, 2};
  UnitParams barrier{13, 2};  // bar.sync of an H200: 12.75 cycles, and 2 per warp
  UnitParams rt_unit{4, 4};   // time to hand over rays, counted when they have come back
  static ParamList params() {
    return {
        section(&Units::integer, "int", "Times of integer arithmetic and logic."),
        section(&Units::int_div, "int_div",
                "Times of integer division, which runs on the special-function pipe."),
        section(&Units::fp32, "fp32", "Times of single-precision arithmetic."),
        section(&Units::fp_div, "fp_div",
                "Times of single-precision division, which runs on the special-function pipe."),
        section(&Units::fp64, "fp64", "Times of double-precision arithmetic."),
        section(&Units::fp64_div, "fp64_div", "Times of double-precision division and roots."),
        section(&Units::fp16, "fp16", "Times of 16-bit floats, which run on the single-precision pipe."),
        section(&Units::sfu, "sfu", "Times of transcendental functions and roots."),
        section(&Units::move, "move", "Times of moves and selections, which run on the integer pipe."),
        section(&Units::predicate, "predicate",
                "Times of comparisons and predicate logic, which run on the integer pipe."),
        section(&Units::shuffle, "shuffle", "Times of shuffles, votes, matches and reductions across lanes."),
        section(&Units::tensor, "tensor",
                "Times of products of matrices (mma), which have a pipe of their own."),
        section(&Units::lsu, "lsu",
                "Times of address generation. The latency lasts up to the L1, and the interval is per "
                "scheduler."),
        section(&Units::constant, "const", "Times of constant loads."),
        section(&Units::tex, "tex",
                "Times of the texture and image unit. The latency lasts up to the L1, and the interval is "
                "per core."),
        section(&Units::branch, "branch",
                "Times of branches, calls and returns. The warp waits for the latency."),
        section(&Units::barrier, "barrier",
                "Times of barriers and fences. The warp waits at least for the latency."),
        section(&Units::rt_unit, "rt_unit",
                "Times of ray instructions. The latency begins with the RT unit's answer.")};
  }
  // Returns the units in the order of isa::Unit.
  std::array<UnitParams, size_t(isa::Unit::Count)> by_unit() const {
    return std::array{integer,   int_div, fp32,   fp_div, fp64,     fp64_div, fp16,   sfu,     move,
                      predicate, shuffle, tensor, lsu,    constant, tex,      branch, barrier, rt_unit};
  }
};

// Holds the parameters of the load-store unit. Defaults: RTX A6000, MICRO 2025 ("Analyzing Modern NVIDIA GPU
// cores"), sections 5.3 and 5.4.
struct LsuParams {
  uint32_t queue = 5;  // 4 entries and a latch, so 5 can issue back to back
  uint32_t accept_interval = 2;
  uint32_t sectors_per_cycle = 2;  // 512 bits per cycle between L1 and registers
  uint32_t accesses = 128;         // Choice: unpublished; 4 per resident warp at 32 warps
  // An H200 looks up 4 lines per cycle, and reads the words of a bank one after another.
  uint32_t lines_per_cycle = 1;  // Volta and later: one line of 128 B per cycle
  bool bank_conflicts = false;
  // Registers of a load may be overwritten after 11 cycles, those of a shared load after 9 (table 2 there).
  uint32_t war_latency = 11, shared_war_latency = 9;
  // An H200 has 204 and 15 cycles, merges 4 lines and takes turns. What other parts do is unpublished.
  uint32_t atomic_latency = 0, atomic_interval = 0, merged_lines = 0;
  bool atomic_turns = false;
  bool holds_operands() const { return war_latency + shared_war_latency > 0; }
  static ParamList params() {
    return {
        param(&LsuParams::queue, "queue", "instruction",
              "Number of memory instructions that each scheduler's queue holds.", 1, 16),
        param(&LsuParams::accept_interval, "accept_interval", "cycle",
              "Cycles from one warp instruction that the core's load-store unit takes to the next.", 1, 64),
        param(&LsuParams::sectors_per_cycle, "sectors_per_cycle", "sector",
              "Number of 32 B sectors asked of the L1 per cycle.", 1, 4),
        param(&LsuParams::accesses, "accesses", "instruction",
              "Largest number of memory instructions of a core between issue and completion.", 1, 1024),
        param(&LsuParams::lines_per_cycle, "lines_per_cycle", "line",
              "Number of lines of one access asked of the L1 per cycle.", 1, 32),
        flag(&LsuParams::bank_conflicts, "bank_conflicts",
             "True: an access to global memory takes a cycle for each different word in the fullest of 32 "
             "banks of 4 bytes."),
        param(&LsuParams::war_latency, "war_latency", "cycle",
              "Cycles from a memory instruction that does not wait in its queue to the first instruction "
              "that may overwrite its sources. 0: sources are read at issue.",
              0, 1000),
        param(&LsuParams::shared_war_latency, "shared_war_latency", "cycle",
              "Cycles from an instruction on shared memory that does not wait in its queue to the first "
              "instruction that may overwrite its sources. 0: sources are read at issue.",
              0, 1000),
        param(&LsuParams::atomic_latency, "atomic_latency", "cycle",
              "Extra cycles from an atomic on global memory to its result, compared with a load.", 0, 10000),
        param(&LsuParams::atomic_interval, "atomic_interval", "cycle",
              "Cycles that an atomic on global memory keeps the way to the L1 busy. 0: it takes as long as a "
              "store.",
              0, 1000),
        flag(&LsuParams::atomic_turns, "atomic_turns",
             "True: lanes of an atomic that meet in a word of global memory take turns there. False: each "
             "sector has one turn."),
        param(&LsuParams::merged_lines, "merged_lines", "line",
              "Largest number of lines of a store that leaves together with the warp's store before it, if "
              "both touch the same lines and the earlier one still waits for the L1. 0: no stores leave "
              "together.",
              0, 32)};
  }
};

// Holds the parameters of the texture unit. Defaults: Turing has four texture units per core, each with one
// bilinear sample per cycle (Turing whitepaper, 2018, TU102: 288 units in 72 cores). Choice: the unit has a
// queue and a door of its own, as MICRO 2025 draws it; its depth is not published.
struct TextureParams {
  uint32_t samples_per_cycle = 4;
  uint32_t queue = 5;
  bool own_door = true;
  static ParamList params() {
    return {
        param(&TextureParams::samples_per_cycle, "samples_per_cycle", "sample",
              "Number of samples of up to four texels per cycle and core. 0: only the unit's interval limits "
              "samples.",
              0, 128),
        param(&TextureParams::queue, "queue", "instruction",
              "Number of texture and image instructions that a queue of each scheduler holds. 0: they wait "
              "in the queue of loads.",
              0, 16),
        flag(&TextureParams::own_door, "own_door",
             "True: texels and loads are asked of the L1 in the same cycle when its ports permit it.")};
  }
};

// Holds the parameters of the register file. Defaults: MICRO 2025, section 5.3: two banks per sub-core with a
// port each, read within three cycles. Banks are off, because an ideal register file predicts as well there.
// Model: there is no cache of operands, and memory instructions read when the ports are free.
struct RegisterFileParams {
  uint32_t banks = 0, window = 3;
  static ParamList params() {
    return {
        param(&RegisterFileParams::banks, "banks", "bank",
              "Number of banks of a scheduler's registers. Register r is in bank r mod this number. 0: there "
              "are no conflicts.",
              0, kMaxRegisterBanks),
        param(&RegisterFileParams::window, "window", "cycle",
              "Cycles in which an instruction of fixed latency reads its registers, one per bank and cycle.",
              1, 16)};
  }
};

// Holds the times of fences. Defaults: an H200's, measured without stores before the fence. Model: no
// acknowledgement travels. A fence waits until the warp's accesses have been answered or taken by the L1,
// whose queue keeps their order, and then for this time.
struct FenceParams {
  uint32_t block = 36, gpu = 289, system = 1055;
  uint32_t acknowledgement = 0;  // H200: 286; 0: stores are done when they have left their core
  static ParamList params() {
    return {param(&FenceParams::block, "block", "cycle",
                  "Cycles that membar.cta takes after the warp's last access.", 1, 60000),
            param(&FenceParams::gpu, "gpu", "cycle",
                  "Cycles that membar.gl takes after the warp's last access.", 1, 60000),
            param(&FenceParams::system, "system", "cycle",
                  "Cycles that membar.sys takes after the warp's last access.", 1, 60000),
            param(&FenceParams::acknowledgement, "acknowledgement", "cycle",
                  "Extra cycles of membar.gl after a store to global memory.", 0, 60000)};
  }
};

// Holds the times of asynchronous copies and of barriers in shared memory, apart from those of the accesses
// that they make. Defaults: microbenchmarks of an H200 (bench/probes/async.cu; docs/validation.md).
struct AsyncParams {
  uint32_t copy_wait = 22;     // copy and wait take 54 cycles from the L1, 273 to 318 from the L2
  uint32_t suspension = 5819;  // 5,830 and 7,776 in two programs, which are 3 and 4 microseconds
  uint32_t wake = 67;          // 88 and 150 from an arrival to behind the wait, in two programs
  static ParamList params() {
    return {
        param(&AsyncParams::copy_wait, "copy_wait", "cycle",
              "Cycles that cp.async.wait_group takes after the last copy that it waits for.", 1, 60000),
        param(&AsyncParams::suspension, "suspension", "cycle",
              "Cycles after which mbarrier.try_wait answers that the phase has not ended.", 1, 10'000'000),
        param(&AsyncParams::wake, "wake", "cycle",
              "Cycles from an arrival that ends a phase to the next instruction of a warp that waits for it "
              "in mbarrier.try_wait.",
              1, 60000)};
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
  PolicyChoice<Reorder> reorder{"none"};
  ReorderParams reordering;
  PolicyChoice<Parking> parking{"none"};
  ParkingLotParams parking_lot;
  PolicyChoice<Interleaving> interleaving{"none"};
  SubwarpParams subwarps;
  Units units;
  // An H200 has a crossing of 1 cycle: a result takes 4 cycles within a pipe and 5 to another, or 17 and 18
  // from the special-function unit. It has a guard delay of 9 cycles: a comparison's result selects after 4
  // cycles and guards after 13. The defaults are 0, because the latencies of other parts include these.
  uint32_t pipe_crossing = 0, guard_delay = 0;
  // Results of fixed latency are written in the order of their ends, because nothing checks them (MICRO 2025,
  // section 4.1).
  bool write_order = false;
  bool dispatch_latch = false;
  RegisterFileParams register_file;
  FetchParams fetch;
  ConstantParams constant;
  CodeCacheParams code_cache;
  LsuParams lsu;
  bool local_by_thread = false;  // Hardware behaves as with false.
  TextureParams texture;
  SharedParams shared;
  FenceParams fence;
  AsyncParams async;
  PrologueParams prologue;
  // Hardware behaves as with true. With false, the launch ends when its last write has left its core.
  bool ends_when_written = false;
  uint32_t launch_latency = 5000;  // Vulkan-Sim, -gpgpu_kernel_launch_latency
  uint32_t warp_launch_latency = 0;
  // In GPGPU-Sim and Accel-Sim, a core takes one block per cycle (issue_block2core).
  uint32_t block_interval = 1;
  double grid_interval = 0;     // an H100: 1.19; 0, because that of other parts is unpublished
  double cluster_interval = 0;  // an H200: 4.8; 0, because that of other parts is unpublished
  uint32_t refill_latency = 0;  // an H200: 200 to 300; 0, because that of other parts is unpublished
  PolicyChoice<exec::WarpLayout> layout{"linear"};
  uint64_t instruction_budget = 100'000'000;
  // Choice: this is 15 ms of a GPU. Only warps that spin are known to make so little progress for so long.
  uint64_t livelock_budget = 20'000'000;
  // Choice: this is 15 ms of a GPU, in which it makes a whole frame. Simulating them takes minutes at most.
  uint64_t turnover_budget = 20'000'000;
  static ParamList params() {
    ParamList out = {
        param(&Params::warps, "warps", "warp",
              "Largest number of resident warps of a core. Registers may limit it further.", 1, kMaxWarps),
        param(&Params::schedulers, "schedulers", "scheduler",
              "Number of schedulers of a core. Warp slot w belongs to scheduler w mod this number.", 1,
              kMaxSchedulers),
        param(&Params::registers, "registers", "register", "Number of 32-bit registers of a core.", 256,
              1 << 20),
        param(&Params::blocks, "blocks", "block",
              "Largest number of resident blocks of a core. Launches without blocks are not limited by it.",
              1, kMaxWarps),
        param(&Params::shared_bytes, "shared_bytes", "byte", "Size of the shared memory of a core.", 0,
              1 << 20),
        policy(&Params::issue, "issue", "Selects the ready warp that a scheduler issues from."),
        policy(&Params::op_times, "op_times",
               "Selects the times of single ops, which may differ from those of their unit."),
        policy(&Params::reorder, "reorder",
               "Selects where threads of a core's warps are regrouped, and what they are sorted by."),
        section(&Params::reordering, "reordering", "Parameters of the regrouping of threads."),
        policy(&Params::parking, "parking",
               "Selects when a warp gives up its place in its core while its rays are in the RT unit."),
        section(&Params::parking_lot, "parking_lot",
                "Parameters of the warps that have given up their places."),
        policy(&Params::interleaving, "interleaving",
               "Selects when another path of a diverged warp runs because one waits for memory."),
        section(&Params::subwarps, "subwarps", "Parameters of the paths of a warp that take turns."),
        section(&Params::units, "units", "Latencies and initiation intervals of the execution units."),
        param(&Params::pipe_crossing, "pipe_crossing", "cycle",
              "Extra cycles before an instruction on another pipe can read a result.", 0, 100),
        param(&Params::guard_delay, "guard_delay", "cycle",
              "Extra cycles before a predicate can guard an instruction, compared with reading it as an "
              "operand.",
              0, 100),
        flag(&Params::write_order, "write_order",
             "True: an instruction waits at issue for earlier results of its register. False: it only has to "
             "end after them."),
        flag(&Params::dispatch_latch, "dispatch_latch",
             "True: one instruction per pipe may issue while the pipe is busy, and waits in front of it. "
             "False: warps issue only to free pipes."),
        section(&Params::register_file, "register_file", "Parameters of the register-file banks."),
        section(&Params::fetch, "fetch", "Parameters of the schedulers' instruction caches."),
        section(&Params::constant, "constant", "Parameters of the constant cache."),
        section(&Params::code_cache, "code_cache",
                "Parameters of the cache behind the instruction and constant caches."),
        section(&Params::lsu, "lsu", "Parameters of the load-store unit."),
        flag(&Params::local_by_thread, "local_by_thread",
             "True: payloads, locals and hit attributes of a thread lie together, apart from those of other "
             "threads, and a shader reads its ray from memory. False: words at the same place of the stacks "
             "of a warp lie side by side, and rays are in registers."),
        section(&Params::texture, "texture", "Parameters of the texture unit."),
        section(&Params::shared, "shared", "Times of shared memory, which has 32 banks of 4 bytes."),
        section(&Params::fence, "fence", "Times of memory fences."),
        section(&Params::async, "async", "Times of asynchronous copies and of barriers in shared memory."),
        section(&Params::prologue, "prologue",
                "Numbers of machine instructions that each warp executes before its first instruction.")};
    for (auto& of_launch : launch_params()) out.push_back(std::move(of_launch));
    return out;
  }

  // Returns the parameters of how a launch begins and ends.
  static ParamList launch_params() {
    return {
        param(&Params::launch_latency, "launch_latency", "cycle",
              "Cycles from the launch to the first instruction.", 0, 1'000'000),
        flag(&Params::ends_when_written, "ends_when_written",
             "True: the launch ends when its last write is in the L2. False: it ends when its last write has "
             "left its core."),
        param(&Params::warp_launch_latency, "warp_launch_latency", "cycle",
              "Cycles from the taking of a warp slot to the warp's first instruction.", 0, 100'000),
        param(&Params::block_interval, "block_interval", "cycle",
              "Cycles from the start of a block on a core to the start of the next.", 0, 10'000),
        param(&Params::grid_interval, "grid_interval", "cycle",
              "Cycles from the start of a block to the start of the next on any core, in steps of 1/16. 0: "
              "blocks on different cores start together.",
              0.0, 10'000.0),
        param(&Params::cluster_interval, "cluster_interval", "cycle",
              "Cycles from the start of a block to the start of the next on any core, in steps of 1/16, when "
              "each block is a cluster (PTX's .reqnctapercluster 1). 0: such blocks start as others do.",
              0.0, 10'000.0),
        param(&Params::refill_latency, "refill_latency", "cycle",
              "Cycles from the end of a block to the first instruction of the block that takes its place.", 0,
              100'000),
        policy(
            &Params::layout, "warp_layout",
            "Selects which threads of a launch form a warp, and the order in which warps and blocks start."),
        param(&Params::instruction_budget, "instruction_budget", "instruction",
              "Number of instructions after which a warp is taken to be endless.", 1, uint64_t{1} << 40),
        param(&Params::livelock_budget, "livelock_budget", "cycle",
              "Cycles without the end of a warp or ray and without a change in memory after which the "
              "machine is taken to spin for ever. 0: there is no limit.",
              0, uint64_t{1} << 40),
        param(
            &Params::turnover_budget, "turnover_budget", "cycle",
            "Cycles in which no warp begins or ends after which the launch is taken to be in a loop without "
            "an end. 0: there is no limit.",
            0, uint64_t{1} << 40)};
  }
};

}  // namespace glint::core
