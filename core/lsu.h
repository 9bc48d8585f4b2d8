// Models the load-store unit of a core: takes accesses from the schedulers' queues and sends their lines to
// the L1.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"
#include "core/coalesce.h"
#include "core/params.h"
#include "isa/atomic.h"
#include "memsys/host_block.h"
#include "memsys/l1_port.h"
#include "memsys/ring.h"

namespace glint::core {

// Holds a warp's access between issue and completion.
struct MemoryAccess {
  explicit MemoryAccess(uint32_t line_bytes) : lines(line_bytes) {}
  uint32_t slot = 0;  // warp slot
  uint32_t pc = 0;
  Cycle issued = 0;
  Cycle late_until = 0;  // the registers that it fills are not written before this cycle
  mem::Traffic traffic = mem::Traffic::ShaderGlobal;
  bool write = false;
  bool texture = false;       // It goes through the texture unit.
  uint32_t samples = 0;       // number of samples of up to four texels; 0 unless `texture`
  bool atomic = false;        // an atomic that shared memory does, if the word is there
  bool merges_lanes = false;  // the lanes of an atomic that meet in a word of shared memory take one turn
  isa::AtomicKind atomic_kind = isa::AtomicKind::Integer;
  bool is_of_matrices = false;   // an ldmatrix or a stmatrix
  uint32_t bank_turns = 1;       // words of the fullest bank of the L1's array, where banks count
  uint32_t passes = 0;           // passes of shared memory; a generic access may go there and to lines
  uint32_t num_table_lines = 0;  // the first lines, which hold the candidates that the called shaders see

 private:
  friend class Lsu;
  uint32_t num_sent = 0, num_answers = 0;
  Cycle hold = 0;   // cycles of the L1's array before its first line, for words that meet in a bank
  Cycle ready = 0;  // cycle in which its first line can go from the pipe to the L1

 public:
  LineList lines;  // It takes more room than all else, so it comes last.
};

// Takes accesses through these stages: queue of each scheduler -> (accept_interval) -> load-store pipe ->
// lines_per_cycle -> L1, or -> shared memory, one pass per cycle. The texture pipe has the same stages, with
// queues and a door of its own, or it shares those of loads. Model: shared memory and L1 do not disturb each
// other, although hardware has one array for both.
class Lsu {
 public:
  Lsu(const Params& params, mem::L1Port& l1);

  // Returns whether an instruction of that scheduler can issue: its queue and the table of accesses have
  // room.
  bool can_take(uint32_t scheduler, bool texture = false) const {
    const Group& group = groups_[texture && own_queue_];
    return !free_.empty() && group.queues[scheduler].count < group.capacity;
  }
  // Returns a number that grows whenever can_take() may have become true for some scheduler.
  uint64_t num_vacated() const { return num_vacated_; }
  // Returns a new access at the end of the scheduler's queue. The caller fills in all of it before the next
  // tick.
  MemoryAccess& take(uint32_t scheduler, Cycle now, bool texture = false);
  // Advances to `now`. Afterwards completed() holds the accesses that ended in this cycle, each once: reads
  // when their last line has come, and writes when the L1 has taken the last line.
  void tick(Cycle now) {
    forget_news();
    if (is_due(now)) run(now);
  }
  // Forgets completed() and accepted(), as the next tick() does.
  void forget_news() {
    completed_.clear();
    num_accepted_ = 0;
  }
  // Returns whether tick() would do anything.
  bool is_due(Cycle now) const { return (now >= due_) | l1_.has_answer(now, mem::Client::Lsu); }
  // Returns whether completed() or accepted() has an access.
  bool has_news() const { return (num_accepted_ != 0) | !completed_.empty(); }
  std::span<const uint32_t> completed() const { return {completed_.data(), completed_.size()}; }
  // Returns the accesses that have left their queues in this cycle.
  std::span<const uint32_t> accepted() const { return {accepted_.data(), num_accepted_}; }
  const MemoryAccess& access(uint32_t id) const { return accesses_[id]; }
  // Returns the number of an access that take() has given.
  uint32_t number_of(const MemoryAccess& access) const { return uint32_t(&access - &accesses_[0]); }
  void release(uint32_t id) {
    free_.push_back(id);
    ++num_vacated_;
  }
  // Returns the earliest cycle after `now` with work of its own, or kNever. Answers are the L1's events.
  Cycle next_event(Cycle now) const { return due_ == kNever ? kNever : std::max(due_, now + 1); }
  bool idle() const { return free_.size() == accesses_.size(); }

 private:
  static constexpr uint32_t kMaxQueue = 16;
  struct Queue {
    std::array<uint32_t, kMaxQueue> id{};
    uint32_t head = 0, count = 0;
    Cycle free_at = 0;  // cycle from which this scheduler's address generation is free
  };
  struct Group {  // queues from which one unit takes in turn
    std::array<Queue, kMaxSchedulers> queues{};
    uint32_t filled = 0;  // bit i: queues[i] holds an access
    uint32_t capacity = 0, next = 0;
    Cycle accept_at = 0;
  };
  struct Pipe {  // accesses in order
    mem::Ring<uint32_t> ids;
    Cycle free_at = 0;
  };

  void run(Cycle now);
  void take_answers(Cycle now);
  void accept(Group& group, Cycle now);
  bool accept_from(Group& group, uint32_t queue, Cycle now);
  void enter(uint32_t id, Pipe& pipe, Cycle now);
  bool merge(uint32_t id);
  void send(Cycle now);
  size_t door_of(size_t pipe) const { return own_door_ && pipe == 1; }
  Cycle texture_cycles(const MemoryAccess& access) const;
  bool send_line(Cycle now, size_t pipe);
  void finish_shared(Cycle now);
  Cycle find_due(Cycle now) const;
  static size_t pipe_of(const MemoryAccess& access) {
    return access.lines.lines().empty() ? kShared : access.texture;
  }
  // Returns the latency of `turns` further turns of the banks.
  Cycle conflict_latency(Cycle turns) const {
    return std::max<Cycle>(turns * shared_.conflict_turn, shared_.conflict_hidden) - shared_.conflict_hidden;
  }
  Cycle shared_cycles(const MemoryAccess& access) const;
  Cycle shared_latency(const MemoryAccess& access) const;

  mem::L1Port& l1_;
  const LsuParams params_;
  const SharedParams shared_;
  const UnitParams lsu_unit_, tex_unit_;
  const uint32_t samples_per_cycle_;
  std::array<uint8_t, 9> sector_cycles_{};  // cycles of a door for so many sectors of a line
  const bool own_queue_, own_door_;         // the texture unit has a queue and a door of its own
  std::array<Group, 2> groups_;  // the group of loads and stores, and that of textures if they have their own
  static constexpr size_t kShared = 2;
  std::array<Pipe, 3> pipes_;  // load-store, texture, shared memory
  uint32_t next_pipe_ = 0;
  std::array<Cycle, 2> door_free_{};  // doors to the L1; the second is the texture unit's own
  static constexpr uint32_t kNoStore = ~0u;
  std::vector<uint32_t> waiting_store_;  // by warp slot: the last store, until its first line is sent
  std::array<uint32_t, 2> accepted_{};
  uint32_t num_accepted_ = 0;
  uint64_t num_vacated_ = 0;
  Cycle due_ = kNever;  // first cycle with work of the unit's own, unless answers of the L1 come before
  // Accesses are made when they are used first, because the table is large and hardly ever full.
  mem::HostArray<MemoryAccess> accesses_;
  uint32_t num_made_ = 0;                   // They have the first numbers.
  std::vector<uint32_t> free_, completed_;  // reserved once
};

}  // namespace glint::core
