// Decodes once what the issue logic needs of each instruction: its pipe, its latency, its registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/op_times.h"
#include "core/params.h"
#include "core/stall.h"
#include "exec/image.h"
#include "isa/atomic.h"
#include "isa/op_row.h"

namespace glint::core {

// Names the pipes. Model: each scheduler has one pipe of each kind, as a Turing sub-core has. Int, move and
// predicate share the integer pipe, and divisions run on the special-function pipe. Memory is the door to the
// units that all schedulers share (load-store, texture); a queue (core/lsu.h) limits it, not an interval.
enum class Pipe : uint8_t { Int, Fp32, Fp64, Sfu, Tensor, Const, Branch, RtUnit, Memory, Count };
inline constexpr int kNumPipes = int(Pipe::Count);
// These are the pipes that an instruction may find busy: all but the memory's, which comes last.
inline constexpr int kNumTimedPipes = int(Pipe::Memory);
static_assert(kNumTimedPipes + 1 == kNumPipes);
Pipe pipe_of(isa::Unit unit);

// Names the queue in front of a shared unit that an instruction has to enter.
enum class Door : uint8_t { None, Lsu, Texture, RtUnit, Count };
inline constexpr int kNumDoors = int(Door::Count);

using isa::Finish;  // the fixed times of an instruction are IssueRow::latency

// This is the scoreboard index of the first predicate. The indices of 32-bit registers come first. The last
// two indices belong to no register: one is always ready, and nobody reads the other.
inline constexpr uint16_t kFirstPredicate = 256;
inline constexpr uint16_t kNoUse = kFirstPredicate + isa::kNumPredicates, kNoDef = kNoUse + 1;
inline constexpr uint16_t kScoreboardEntries = kNoDef + 1;

struct alignas(32) IssueRow {
  // This is the index into IssueTable's list of registers that have to be ready, the destinations last.
  uint32_t first_use = 0;
  uint8_t num_uses = 0;  // including the destinations
  uint8_t num_defs = 0;
  Pipe pipe = Pipe::Int;
  Finish finish = Finish::Fixed;
  Door door = Door::None;
  isa::Stage stage = isa::Stage::Compute;
  Stall wait = Stall::RawFixed;     // what a dependent instruction waits for
  bool is_conditional : 1 = false;  // a guarded branch
  bool is_guarded : 1 = false;      // the last source is its guard
  bool alternates : 1 = false;      // OpTime::alternates
  bool is_texture : 1 = false;      // goes through the texture unit
  bool is_sequence : 1 = false;     // IssueTable::issues() is more than 1
  bool is_whole : 1 = false;        // OpTime::whole
  isa::AtomicKind atomic : 2 = isa::AtomicKind::Integer;
  SlowPath slow_path = SlowPath::None;
  bool merges_lanes : 1 = false;  // lanes that meet in a word of shared memory take one turn
  // The instruction does nothing but compute its values in a fixed time, reads at most kFirstUses registers
  // and writes at most one. Most instructions do.
  bool is_value : 1 = false;
  bool is_mbarrier : 1 = false;  // an mbarrier.*, which other warps may wait for (core/mbarrier_unit.h)
  bool is_copy : 1 = false;      // a cp.async, or an arrival that waits for some (core/async_copies.h)
  uint16_t latency = 1;
  uint16_t interval = OpTime::kParts;  // interval of the pipe, in parts of a cycle
  // These are the first of the registers that have to be ready, and the first destination. Most instructions
  // have no more. Loops of a fixed length over these cost the host no mispredicted branch.
  static constexpr size_t kFirstUses = 4;
  std::array<uint16_t, kFirstUses> first_uses{kNoUse, kNoUse, kNoUse, kNoUse};
  uint16_t first_def = kNoDef;
};
static_assert(sizeof(IssueRow) == 32);

// Holds all instructions of an image. It is not written while the core runs.
class IssueTable {
 public:
  IssueTable(const exec::Image& image, const Params& params);
  const IssueRow& row(uint32_t pc) const { return rows_[pc]; }
  // Returns sources, guard and destinations, which all have to be ready before issue.
  std::span<const uint16_t> uses(const IssueRow& row) const {
    return {registers_.data() + row.first_use, row.num_uses};
  }
  // Returns the registers that a memory instruction reads when it leaves its queue: the sources without the
  // guard.
  std::span<const uint16_t> sources(const IssueRow& row) const {
    return {registers_.data() + row.first_use, size_t(row.num_uses - row.num_defs - row.is_guarded)};
  }
  std::span<const uint16_t> defs(const IssueRow& row) const {
    return {registers_.data() + row.first_use + row.num_uses - row.num_defs, row.num_defs};
  }
  // Returns the number of machine instructions that the instruction at `pc` stands for; more than 1 is a
  // sequence.
  uint32_t issues(uint32_t pc) const { return issues_[pc]; }
  // Holds the registers that an instruction of fixed latency reads from each bank of the register file, at
  // most as many as the window has cycles. It is empty when there are no banks.
  using BankReads = std::array<uint8_t, kMaxRegisterBanks>;
  const BankReads& bank_reads(uint32_t pc) const { return bank_reads_[pc]; }

 private:
  void count_bank_reads(const IssueRow& row, const RegisterFileParams& params);

  std::vector<IssueRow> rows_;
  std::vector<BankReads> bank_reads_;
  std::vector<uint8_t> issues_;
  std::vector<uint16_t> registers_;
};

}  // namespace glint::core
