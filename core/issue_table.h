// What the issue logic needs of each instruction, decoded once: its pipe, its latency, its registers.
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
#include "isa/op_row.h"

namespace glint::core {

// Model: each scheduler has one pipe of each kind, as a Turing sub-core has; int, move and predicate share
// the integer pipe; divisions run on the special-function pipe. Memory is the door to the units that all
// schedulers share (load-store, texture): it is limited by a queue (core/lsu.h), not by an interval.
enum class Pipe : uint8_t { Int, Fp32, Fp64, Sfu, Const, Branch, RtUnit, Memory, Count };
inline constexpr int kNumPipes = int(Pipe::Count);
Pipe pipe_of(isa::Unit unit);

// How an instruction's end is known.
enum class Finish : uint8_t {
  Fixed,       // `latency` cycles after issue
  Memory,      // when the L1 has answered
  Rays,        // when the RT unit has answered
  Control,     // fixed, and the warp does not issue before
  CallRecord,  // as Control, and then when the record of the binding table has been read
  Barrier,     // when the other warps have come; of bar.arrive, as Control
  Fence,       // when the warp's earlier accesses are done, and then `latency` cycles
};

struct IssueRow {
  uint32_t first_use = 0;  // of IssueTable's list: registers to be ready, the destinations last
  uint8_t num_uses = 0;    // with the destinations
  uint8_t num_defs = 0;
  Pipe pipe = Pipe::Int;
  Finish finish = Finish::Fixed;
  isa::Class klass = isa::Class::Alu;
  isa::Stage stage = isa::Stage::Compute;
  Stall wait = Stall::RawFixed;     // what a dependent instruction waits for
  bool is_conditional : 1 = false;  // a guarded branch
  bool is_guarded : 1 = false;      // the last source is its guard
  bool alternates : 1 = false;      // OpTime::alternates
  bool is_texture : 1 = false;      // through the texture unit
  bool is_sequence : 1 = false;     // IssueTable::issues() is more than 1
  AtomicKind atomic : 2 = AtomicKind::Integer;
  uint16_t latency = 1;
  uint16_t interval = OpTime::kParts;  // of the pipe, in parts of a cycle
};
static_assert(sizeof(IssueRow) == 16);

// Scoreboard index of a predicate; 32-bit registers come first.
inline constexpr uint16_t kFirstPredicate = 256;
inline constexpr uint16_t kScoreboardEntries = kFirstPredicate + isa::kNumPredicates;

// All instructions of an image. Read-only while running.
class IssueTable {
 public:
  IssueTable(const exec::Image& image, const Params& params);
  const IssueRow& row(uint32_t pc) const { return rows_[pc]; }
  // Sources, guard and destinations: all have to be ready before issue.
  std::span<const uint16_t> uses(const IssueRow& row) const {
    return {registers_.data() + row.first_use, row.num_uses};
  }
  // Registers that a memory instruction reads when it leaves its queue: the sources without the guard.
  std::span<const uint16_t> sources(const IssueRow& row) const {
    return {registers_.data() + row.first_use, size_t(row.num_uses - row.num_defs - row.is_guarded)};
  }
  std::span<const uint16_t> defs(const IssueRow& row) const {
    return {registers_.data() + row.first_use + row.num_uses - row.num_defs, row.num_defs};
  }
  // Instructions of the part that the one at `pc` stands for, where it is a sequence.
  uint32_t issues(uint32_t pc) const { return issues_[pc]; }
  // Registers that an instruction of fixed latency reads from each bank of the register file, at most the
  // window's cycles. Empty where there are no banks.
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
