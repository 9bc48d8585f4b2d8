// Walks every path of a program once, with the stack of what is open on it: regions of ssy, traces, calls.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unordered_map>
#include <vector>

#include "isa/op_row.h"
#include "isa/verify_flow.h"

namespace glint::isa {
namespace {

const OpRow& row_of(const Inst& inst) {
  return op_table()[inst.op];
}

// Holds stacks of open things as a tree. A stack is named by its top, and equal stacks have equal numbers.
class Stacks {
 public:
  static constexpr int32_t kNone = -1;                               // not reached
  static constexpr int32_t kTrace = -1, kMain = -2, kFunction = -3;  // marks; from 0 on: the join of a region
  static constexpr uint32_t kInMain = 0, kInFunction = 1;            // the two empty stacks

  Stacks() : nodes_{{0, kMain}, {1, kFunction}} {}

  uint32_t push(uint32_t stack, int32_t what) {
    const uint64_t key = uint64_t{stack} << 32 | uint32_t(what);
    const auto [it, is_new] = found_.emplace(key, uint32_t(nodes_.size()));
    if (is_new) nodes_.push_back({stack, what});
    return it->second;
  }
  int32_t top(uint32_t stack) const { return nodes_[stack].what; }
  uint32_t below(uint32_t stack) const { return nodes_[stack].below; }

  // Returns the part of the stack up to the innermost region of `join`, or kNone. A region cannot be left
  // across a trace.
  int32_t up_to(uint32_t stack, int32_t join) const {
    for (; top(stack) >= 0; stack = below(stack))
      if (top(stack) == join) return int32_t(stack);
    return kNone;
  }
  // Returns whether the stack is inside a trace, whatever regions are open in the trace.
  bool in_trace(uint32_t stack) const {
    while (top(stack) >= 0) stack = below(stack);
    return top(stack) == kTrace;
  }
  bool in_function(uint32_t stack) const {
    while (top(stack) != kMain && top(stack) != kFunction) stack = below(stack);
    return top(stack) == kFunction;
  }
  std::string text(uint32_t stack) const {
    std::string out;
    for (; top(stack) != kMain && top(stack) != kFunction; stack = below(stack))
      out = (top(stack) == kTrace ? "a trace" : fmt::format("the region of join {}", top(stack))) +
            (out.empty() ? "" : ", ") + out;
    const std::string place = top(stack) == kFunction ? " of a function" : "";
    return (out.empty() ? "nothing open" : "inside " + out) + place;
  }

 private:
  struct Node {
    uint32_t below;
    int32_t what;
  };
  std::vector<Node> nodes_;
  std::unordered_map<uint64_t, uint32_t> found_;
};

class RegionWalk {
 public:
  RegionWalk(const Program& program, const Complaint& complain)
      : program_(program), complain_(complain), stack_at_(program.code.size(), Stacks::kNone) {}

  bool run() {
    enter(0, 0, Stacks::kInMain);
    while (!pending_.empty()) {
      const uint32_t at = pending_.back();
      pending_.pop_back();
      visit(at);
    }
    if (is_sound_) report_unreached();
    return is_sound_;
  }

 private:
  const Inst& inst(uint32_t at) const { return program_.code[at]; }
  Effect effect(uint32_t at) const { return row_of(inst(at)).effect; }

  void error(size_t at, const std::string& what) {
    is_sound_ = false;
    complain_(at, what);
  }

  // Notes that a lane comes from `from` to `to` with `stack` open.
  void enter(uint32_t from, size_t to, uint32_t stack) {
    if (to >= program_.code.size()) return error(from, "the code can run off its end here");
    if (effect(uint32_t(to)) == Effect::Join) {
      const int32_t kept = stacks_.up_to(stack, int32_t(to));
      if (kept == Stacks::kNone)
        return error(from,
                     fmt::format("comes to the join at {} outside its region: {}", to, stacks_.text(stack)));
      stack = uint32_t(kept);
    }
    if (stack_at_[to] == Stacks::kNone) {
      stack_at_[to] = int32_t(stack);
      pending_.push_back(uint32_t(to));
    } else if (stack_at_[to] != int32_t(stack)) {
      error(from, fmt::format("comes to instruction {} with {}, but another path comes with {}", to,
                              stacks_.text(stack), stacks_.text(uint32_t(stack_at_[to]))));
    }
  }

  void visit(uint32_t at) {
    const uint32_t before = uint32_t(stack_at_[at]);
    const Effect e = effect(at);
    uint32_t after = before;
    if (e == Effect::PushReconvergence) after = stacks_.push(before, inst(at).imm);
    if (e == Effect::Join) after = stacks_.below(before);
    const TraceUse trace = effect_row(e).trace;
    if (trace == TraceUse::Opens) after = stacks_.push(before, Stacks::kTrace);
    if (trace == TraceUse::Closes) {
      if (stacks_.top(before) != Stacks::kTrace)
        return error(at, fmt::format("no trace is innermost here: {}", stacks_.text(before)));
      after = stacks_.below(before);
    }
    if (trace == TraceUse::Inside && !stacks_.in_trace(before))
      return error(at, "no rt.trace is open on a path to here");
    const bool parts = e == Effect::BranchIndexed || (e == Effect::Branch && inst(at).guard != kNoGuard);
    if (parts && stacks_.top(before) == Stacks::kTrace)
      error(
          at,
          "lanes may diverge inside a trace, but no region is open in which they would meet before its end");
    if (e == Effect::Return) returns(at, before);
    const bool is_call = e == Effect::Call;
    const std::vector<uint32_t> next = successors(program_, at);
    for (size_t i = 0; i < next.size(); ++i)
      enter(at, next[i], is_call && i == 0 ? Stacks::kInFunction : after);
  }

  // Checks a return. Nothing calls ray generation and compute shaders.
  void returns(uint32_t at, uint32_t stack) {
    if (program_.is_entry() && !stacks_.in_function(stack))
      error(at, "this is a return outside a function: ray generation and compute shaders end with exit");
  }

  void report_unreached() {
    for (uint32_t at = 0; at < program_.code.size(); ++at)
      if (stack_at_[at] != Stacks::kNone && effect(at) == Effect::PushReconvergence &&
          stack_at_[size_t(inst(at).imm)] == Stacks::kNone)
        error(at, fmt::format("no path leads to the join at {}, where the lanes should meet", inst(at).imm));
    if (!is_sound_) return;
    for (uint32_t at = 0; at < program_.code.size(); ++at) {
      if (stack_at_[at] != Stacks::kNone) continue;
      const uint32_t first = at;
      while (at + 1 < program_.code.size() && stack_at_[at + 1] == Stacks::kNone) ++at;
      error(first, first == at
                       ? "no path leads here"
                       : fmt::format("no path leads here, nor to the next instructions up to {}", at));
    }
  }

  const Program& program_;
  const Complaint& complain_;
  Stacks stacks_;
  std::vector<int32_t> stack_at_;  // for each instruction: what is open when a lane comes there
  std::vector<uint32_t> pending_;
  bool is_sound_ = true;
};

}  // namespace

std::vector<uint32_t> successors(const Program& program, size_t at) {
  const Inst& inst = program.code[at];
  const Effect e = row_of(inst).effect;
  const bool is_guarded = inst.guard != kNoGuard;
  std::vector<uint32_t> out;
  if (e == Effect::Branch || e == Effect::Call) out.push_back(uint32_t(inst.imm));
  if (e == Effect::BranchIndexed)  // goes into a table of unguarded branches
    for (size_t i = size_t(inst.imm); i < program.code.size(); ++i) {
      const Inst& entry = program.code[i];
      if (row_of(entry).effect != Effect::Branch || entry.guard != kNoGuard) break;
      out.push_back(uint32_t(i));
    }
  if (effect_row(e).flow == Flow::Next || is_guarded) out.push_back(uint32_t(at + 1));
  return out;
}

bool verify_regions(const Program& program, const Complaint& complain) {
  return RegionWalk(program, complain).run();
}

}  // namespace glint::isa
