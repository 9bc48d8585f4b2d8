// Follows data over the paths of a program: which registers and predicates are written, and where the stack
// pointer is.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "isa/op_row.h"
#include "isa/verify_flow.h"

namespace glint::isa {
namespace {

constexpr size_t kNumValues = size_t(kMaxRegisters) + kNumPredicates;  // registers, then predicates

// Says what is known of a value on all paths to a place. Two different facts that meet give Written, unless
// one is Unwritten. Under + guard means: written only in lanes where that guard holds.
enum Fact : uint8_t { Unwritten, Written, Under };

constexpr uint8_t under(uint8_t guard) {
  return uint8_t(Under + 2 * (guard & ~kGuardNegate) + (guard & kGuardNegate ? 1 : 0));
}
constexpr uint8_t opposite(uint8_t fact) {
  return uint8_t(((fact - Under) ^ 1) + Under);
}

struct State {
  static constexpr int64_t kUnknown = INT64_MIN;

  std::array<uint8_t, kNumValues> fact{};
  int64_t stack = 0;  // of %r0: bytes above its value at entry
  bool is_reached = false;

  static State entry() {
    State s;
    s.fact[kStackPointer] = Written;
    s.is_reached = true;
    return s;
  }
  // Keeps what holds in both states. Returns whether that is less than before.
  bool meet(const State& other) {
    if (!is_reached) return *this = other, true;
    const State before = *this;
    for (size_t i = 0; i < kNumValues; ++i)
      if (fact[i] != other.fact[i])
        fact[i] = fact[i] == Unwritten || other.fact[i] == Unwritten ? Unwritten : Written;
    if (stack != other.stack) stack = kUnknown;
    return fact != before.fact || stack != before.stack;
  }
};

// Calls `visit(index, is_destination)` for each register and predicate of an instruction except its guard.
template <class Visit>
void for_each_value(const OpRow& row, const Inst& inst, Visit&& visit) {
  int slot = 0;
  for (const OperandKind kind : row.operands.view()) {
    const bool is_predicate = kind == OperandKind::DstPred || kind == OperandKind::SrcPred;
    const bool is_pair =
        kind == OperandKind::Dst64 || kind == OperandKind::Src64 || kind == OperandKind::Address64;
    for (const int end = slot + slots_of(kind); slot < end; ++slot) {
      const size_t index = inst.operand[size_t(slot)];
      if (is_predicate) {
        visit(size_t(kMaxRegisters) + index, is_destination(kind));
      } else if (index >> kBankShift == 0) {
        visit(index, is_destination(kind));
        if (is_pair) visit(index + 1, is_destination(kind));
      }
    }
  }
}

class ValueFlow {
 public:
  ValueFlow(const Program& program, const Complaint& complain) : program_(program), complain_(complain) {}

  void run() {
    find_blocks();
    find_written_by_functions();
    at_[0] = State::entry();
    std::vector<uint32_t> pending{0};
    is_pending_[0] = true;
    while (!pending.empty()) {
      const uint32_t block = pending.back();
      pending.pop_back();
      is_pending_[block] = false;
      flow(block, pending);
    }
    reports_ = true;
    for (uint32_t block = 0; block < starts_.size(); ++block) {
      State state = at_[block];
      if (!state.is_reached) continue;
      for (uint32_t at = starts_[block]; at < end_of(block); ++at) step(state, at);
    }
  }

 private:
  const Inst& inst(uint32_t at) const { return program_.code[at]; }
  uint32_t size() const { return uint32_t(program_.code.size()); }
  uint32_t end_of(uint32_t block) const { return block + 1 < starts_.size() ? starts_[block + 1] : size(); }

  void find_blocks() {
    std::vector<uint8_t> begins(size() + 1, 0);
    begins[0] = 1;
    for (uint32_t at = 0; at < size(); ++at) {
      const std::vector<uint32_t> next = successors(program_, at);
      if (next.size() == 1 && next[0] == at + 1) continue;
      begins[at + 1] = 1;
      for (const uint32_t to : next) begins[to] = 1;
    }
    block_of_.resize(size());
    for (uint32_t at = 0; at < size(); ++at) {
      if (begins[at]) starts_.push_back(at);
      block_of_[at] = uint32_t(starts_.size()) - 1;
    }
    at_.resize(starts_.size());
    is_pending_.resize(starts_.size());
  }

  // Finds everything that code reached from a call writes. After a call it may have been written and is not
  // checked further.
  void find_written_by_functions() {
    std::vector<uint32_t> pending;
    std::vector<uint8_t> seen(size(), 0);
    const auto reach = [&](uint32_t at) {
      if (!std::exchange(seen[at], 1)) pending.push_back(at);
    };
    for (uint32_t at = 0; at < size(); ++at)
      if (op_table()[inst(at).op].effect == Effect::Call) reach(uint32_t(inst(at).imm));
    while (!pending.empty()) {
      const uint32_t at = pending.back();
      pending.pop_back();
      for_each_value(op_table()[inst(at).op], inst(at),
                     [&](size_t value, bool is_written) { by_functions_[value] |= is_written; });
      for (const uint32_t to : successors(program_, at)) reach(to);
    }
  }

  void flow(uint32_t block, std::vector<uint32_t>& pending) {
    State state = at_[block];
    for (uint32_t at = starts_[block]; at < end_of(block); ++at) step(state, at);
    const uint32_t last = end_of(block) - 1;
    const OpRow& row = op_table()[inst(last).op];
    const std::vector<uint32_t> next = successors(program_, last);
    for (size_t i = 0; i < next.size(); ++i) {
      State out = state;
      if (row.effect == Effect::Call && i > 0)
        for (size_t value = 0; value < kNumValues; ++value)
          if (by_functions_[value]) out.fact[value] = Written;
      if (inst(last).guard != kNoGuard && row.effect == Effect::Branch)
        assume(out, i == 0 ? inst(last).guard : inst(last).guard ^ kGuardNegate);
      const uint32_t to = block_of_[next[i]];
      if (at_[to].meet(out) && !is_pending_[to]) {
        is_pending_[to] = true;
        pending.push_back(to);
      }
    }
  }

  // Notes that on a path where the guard holds, values written under the guard are written.
  static void assume(State& state, uint8_t guard) {
    for (uint8_t& fact : state.fact)
      if (fact == under(guard)) fact = Written;
  }

  void step(State& state, uint32_t at) {
    const Inst& i = inst(at);
    const OpRow& row = op_table()[i.op];
    if (reports_) check(state, i, row, at);
    if (is_shader_call(row.effect)) {
      const uint8_t pointer = state.fact[kStackPointer];
      // The shaders that are called use all registers and predicates (docs/abi.md).
      state.fact.fill(Unwritten);
      state.fact[kStackPointer] = pointer;
    }
    for_each_value(row, i, [&](size_t value, bool is_written) {
      if (is_written) write(state, value, i.guard);
    });
    move_stack(state, i, row);
  }

  static void write(State& state, size_t value, uint8_t guard) {
    uint8_t& fact = state.fact[value];
    if (guard == kNoGuard)
      fact = Written;
    else if (fact == Unwritten)
      fact = under(guard);
    else if (fact != under(guard))
      fact = Written;  // the other lanes are written, or the guard may hold where it is needed
    if (value < size_t(kMaxRegisters)) return;
    // The predicate gets a new value here, so values written under its old value are not followed further.
    const uint8_t held = under(uint8_t(value - kMaxRegisters));
    for (uint8_t& other : state.fact)
      if (other == held || other == opposite(held)) other = Written;
  }

  void move_stack(State& state, const Inst& i, const OpRow& row) const {
    if (row.operands.count == 0 || !is_destination(row.operands.kind[0]) ||
        row.operands.kind[0] == OperandKind::DstPred || i.operand[0] != kStackPointer)
      return;
    const bool adds = row.name == "add.u32" || row.name == "add.s32",
               subtracts = row.name == "sub.u32" || row.name == "sub.s32";
    const Slot step = i.operand[2];
    const bool is_known = (adds || subtracts) && i.guard == kNoGuard && i.operand[1] == kStackPointer &&
                          step >> kBankShift == kConstantBank >> kBankShift && state.stack != State::kUnknown;
    const int64_t bytes = is_known ? int32_t(program_.constants[step & kSlotIndexMask]) : 0;
    state.stack = is_known ? state.stack + (adds ? bytes : -bytes) : State::kUnknown;
  }

  void check(const State& state, const Inst& i, const OpRow& row, uint32_t at) {
    for_each_value(row, i, [&](size_t value, bool is_written) {
      if (!is_written) read(state, value, i.guard, at);
    });
    if (i.guard != kNoGuard) read(state, size_t(kMaxRegisters) + (i.guard & ~kGuardNegate), kNoGuard, at);
    if (state.stack == State::kUnknown) return;
    const Effect e = row.effect;
    if (effect_row(e).flow == Flow::Return && state.stack != 0)
      complain_(
          at, fmt::format("%r0 is {} bytes from its value at entry, where the shader returns", state.stack));
    if (is_shader_call(e) && state.stack < int64_t(program_.local_bytes))
      complain_(at,
                fmt::format(
                    "%r0 is {} bytes above its value at entry, but the frame that a called shader must leave "
                    "alone has {}",
                    state.stack, program_.local_bytes));
    if (row.memory.space == Space::Local) frame(state, i, row, at);
  }

  void read(const State& state, size_t value, uint8_t guard, uint32_t at) {
    const uint8_t fact = state.fact[value];
    if (fact == Written || (fact >= Under && guard != kNoGuard)) return;
    const bool is_predicate = value >= size_t(kMaxRegisters);
    const std::string name =
        fmt::format("%{}{}", is_predicate ? 'p' : 'r', is_predicate ? value - size_t(kMaxRegisters) : value);
    complain_(
        at, fact == Unwritten
                ? fmt::format("{} is read, but nothing has written it on a path to here", name)
                : fmt::format("{} is read by all lanes, but only lanes under a guard have written it", name));
  }

  // Checks that displacements from the stack pointer are within the frame.
  void frame(const State& state, const Inst& i, const OpRow& row, uint32_t at) {
    int slot = 0;
    for (const OperandKind kind : row.operands.view()) {
      if (kind == OperandKind::Address32 && i.operand[size_t(slot)] == kStackPointer) {
        const int64_t first = state.stack + i.imm, end = first + row.memory.bytes * row.memory.count;
        // Above the frame lies that of a function that is called, where its parameters and results are.
        const bool is_of_callee = state.stack >= int64_t(program_.local_bytes) && i.imm >= 0;
        if (!is_of_callee && (first < 0 || end > int64_t(program_.local_bytes)))
          complain_(at, fmt::format("touches bytes {} to {} of the frame, which has {}", first, end - 1,
                                    program_.local_bytes));
      }
      slot += slots_of(kind);
    }
  }

  const Program& program_;
  const Complaint& complain_;
  std::vector<uint32_t> starts_, block_of_;  // first instruction of each block; block of each instruction
  std::vector<State> at_;                    // at the start of each block
  std::vector<uint8_t> is_pending_;
  std::array<uint8_t, kNumValues> by_functions_{};
  bool reports_ = false;
};

}  // namespace

void verify_values(const Program& program, const Complaint& complain) {
  ValueFlow(program, complain).run();
}

}  // namespace glint::isa
