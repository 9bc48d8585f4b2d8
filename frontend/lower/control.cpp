// Lowers structured control flow: reconvergence pairs, branches, switches, and phis as copies on edges.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "base/check.h"
#include "frontend/lower/cfg.h"
#include "frontend/lower/lowering.h"
#include "frontend/spirv/spirv.h"

namespace glint::frontend {
namespace {

// Holds the virtual blocks of one SPIR-V block, in layout order. `joins` has one block for each construct
// that ends here, innermost first. `before` opens a loop's merge region. `top` opens an iteration and is the
// target of back edges.
struct Parts {
  std::vector<std::pair<Construct, BlockId>> joins;
  BlockId before = kNoBlock, top = kNoBlock, body = kNoBlock;

  BlockId after_joins() const { return before != kNoBlock ? before : top != kNoBlock ? top : body; }
};

struct Copy {
  VirtualRegister to;
  RegisterClass c;
  Operand from;
};

class ControlFlow {
 public:
  explicit ControlFlow(ModuleLowering& lowering)
      : lowering_(lowering),
        emit_(lowering.emit()),
        cfg_(lowering.function()),
        parts_(cfg_.num_blocks()),
        known_(cfg_.num_blocks()) {}

  void run() {
    for (uint32_t b : cfg_.reachable()) make_parts(b);
    for (uint32_t b : cfg_.reachable()) declare_phis(b);
    for (uint32_t b : cfg_.reachable()) lower_block(b);
  }

 private:
  void make_parts(uint32_t b);
  void declare_phis(uint32_t b);
  void lower_block(uint32_t b);
  // Returns true for pointers that are not values.
  bool is_place(Id type) const {
    return lowering_.module().type(type).kind == Type::Kind::Pointer && !lowering_.layout().is_address(type);
  }
  void terminator(uint32_t b);
  void conditional(uint32_t b, const Instruction& last);
  void choose(uint32_t b, const Instruction& last);
  void finish_shader(spv::Op op);
  bool is_next(uint32_t from, uint32_t to);
  BlockId target(uint32_t from, uint32_t to) const;
  std::vector<Copy> copies(uint32_t from, uint32_t to);
  void copy_all(std::vector<Copy> pending);
  void go(uint32_t from, uint32_t to);
  BlockId edge(uint32_t from, uint32_t to);
  void place_edges();

  ModuleLowering& lowering_;
  Emitter& emit_;
  ControlGraph cfg_;
  std::vector<Parts> parts_;
  std::vector<Emitter::Known> known_;
  struct Edge {
    BlockId block;
    uint32_t from, to;
  };
  std::vector<Edge> edges_;  // split edges of the present terminator that are not yet placed
};

void ControlFlow::make_parts(uint32_t b) {
  Parts& parts = parts_[b];
  const Block& block = cfg_.block(b);
  for (const Construct& construct : cfg_.constructs_ending_at(b))
    parts.joins.push_back({construct, emit_.new_block(fmt::format("join_{}_{}", block.label,
                                                                  cfg_.block(construct.header).label))});
  if (cfg_.merge_of(b) && block.merge == spv::Op::OpLoopMerge)
    parts.before = emit_.new_block(fmt::format("loop_{}", block.label));
  if (block.merge == spv::Op::OpLoopMerge)
    parts.top = emit_.new_block(fmt::format("iteration_{}", block.label));
  parts.body = emit_.new_block(fmt::format("block_{}", block.label));
}

void ControlFlow::declare_phis(uint32_t b) {
  for (const Instruction& inst : cfg_.block(b).code) {
    if (inst.op != spv::Op::OpPhi) break;
    if (is_place(inst.type)) {
      lowering_.unsupported("OpPhi of pointers", inst.line);
      lowering_.set_pointer(inst.result, nowhere(lowering_.module().type(inst.type).element));
      continue;
    }
    Operands registers;
    for (Part part : lowering_.layout().parts(inst.type))
      registers.push_back(Operand::of(lowering_.program().new_register(class_of(part))));
    lowering_.set(inst.result, std::move(registers));
  }
}

void ControlFlow::lower_block(uint32_t b) {
  const Parts& parts = parts_[b];
  const Block& block = cfg_.block(b);
  emit_.set_line(block.code.front().line);
  for (const auto& [construct, id] : parts.joins) {
    emit_.place(id);
    emit_.effect("join", {});
  }
  if (parts.before != kNoBlock) {
    emit_.place(parts.before);
    emit_.push_reconvergence(cfg_join(parts_[*cfg_.merge_of(b)].joins, b));
  }
  if (parts.top != kNoBlock) {
    emit_.place(parts.top);
    if (const auto continued = cfg_.continue_of(b))
      emit_.push_reconvergence(cfg_join(parts_[*continued].joins, b));
  }
  emit_.place(parts.body);
  const auto only = cfg_.only_predecessor(b);
  emit_.set_known(only ? known_[*only] : Emitter::Known{});
  if (b == 0) lowering_.prologue();
  for (size_t i = 0; i + 1 < block.code.size(); ++i)
    if (block.code[i].op != spv::Op::OpPhi) lowering_.instruction(block.code[i]);
  known_[b] = emit_.known();
  terminator(b);
}

void ControlFlow::terminator(uint32_t b) {
  const Block& block = cfg_.block(b);
  const Instruction& last = block.terminator();
  emit_.set_line(last.line.line ? last.line : block.merge_line);
  if (block.merge == spv::Op::OpSelectionMerge)
    if (const auto merge = cfg_.merge_of(b)) emit_.push_reconvergence(cfg_join(parts_[*merge].joins, b));
  switch (last.op) {
    case spv::Op::OpBranch:
      go(b, cfg_.index_of(last.operands[0]));
      break;
    case spv::Op::OpBranchConditional:
      conditional(b, last);
      break;
    case spv::Op::OpSwitch:
      choose(b, last);
      break;
    default:
      finish_shader(last.op);
      break;
  }
  place_edges();
}

void ControlFlow::finish_shader(spv::Op op) {
  const bool is_called =
      lowering_.stage() != isa::Stage::RayGeneration && lowering_.stage() != isa::Stage::Compute;
  const std::string_view leave = is_called ? "ret" : "exit";
  switch (op) {
    case spv::Op::OpReturn:
      emit_.end(leave);
      break;
    case spv::Op::OpUnreachable:  // A valid program never reaches it.
      emit_.effect("trap", {});
      emit_.end(leave);
      break;
    case spv::Op::OpIgnoreIntersectionKHR:
      emit_.end("rt.ignore");
      break;
    case spv::Op::OpTerminateRayKHR:
      emit_.end("rt.terminate");
      break;
    default:
      lowering_.unsupported(op == spv::Op::OpReturnValue ? "a function that was not inlined"
                                                         : name_of_opcode(uint32_t(op)));
      emit_.end(leave);
      break;
  }
}

void ControlFlow::conditional(uint32_t b, const Instruction& last) {
  const uint32_t if_true = cfg_.index_of(last.operands[1]);
  const uint32_t if_false = cfg_.index_of(last.operands[2]);
  const Operand condition = lowering_.scalar(last.operands[0]);
  if (condition.kind == Operand::Kind::Constant) return go(b, condition.constant ? if_true : if_false);
  if (if_true == if_false) return go(b, if_true);
  // A lane that branches to a join waits there at once. If one side does so, it becomes the taken side of the
  // branch.
  const auto leaves_at_once = [&](uint32_t to) {
    const BlockId at = target(b, to);
    return copies(b, to).empty() && at != parts_[to].after_joins() && at != parts_[to].top;
  };
  const bool true_leaves = leaves_at_once(if_true), false_leaves = leaves_at_once(if_false);
  const bool when = true_leaves != false_leaves ? true_leaves : !is_next(b, if_true);
  const uint32_t other = when ? if_false : if_true;
  emit_.branch_if(condition, when, edge(b, when ? if_true : if_false));
  if (!copies(b, other).empty())
    emit_.place(emit_.new_block(fmt::format("edge_{}_{}", cfg_.block(b).label, cfg_.block(other).label)));
  go(b, other);
}

// Returns whether the edge's target is the next block in the layout, so that no branch is needed.
bool ControlFlow::is_next(uint32_t from, uint32_t to) {
  const auto& order = cfg_.reachable();
  const auto after = std::upper_bound(order.begin(), order.end(), from);
  if (after == order.end() || !copies(from, to).empty()) return false;
  const Parts& parts = parts_[*after];
  return target(from, to) == (parts.joins.empty() ? parts.after_joins() : parts.joins.front().second);
}

// Lowers a switch to a chain of compares with one guarded branch for each target, which covers all of its
// literals.
void ControlFlow::choose(uint32_t b, const Instruction& last) {
  const uint32_t otherwise = cfg_.index_of(last.operands[1]);
  const Operand selector = lowering_.scalar(last.operands[0]);
  const uint32_t bytes = bytes_of(lowering_.layout().parts(lowering_.type_of(last.operands[0]))[0]);
  // Literals carry their sign beyond their width, so they are masked.
  const uint64_t mask = bytes < 8 ? (uint64_t{1} << 8 * bytes) - 1 : ~uint64_t{0};
  std::vector<std::pair<uint32_t, Operand>> cases;  // target, predicate
  const uint32_t words = last.literal_words;
  for (size_t i = 2; i + words < last.operands.size(); i += 1 + words) {
    const uint32_t to = cfg_.index_of(last.operands[i + words]);
    if (to == otherwise) continue;
    const uint64_t literal = last.operands[i] | (words == 2 ? uint64_t{last.operands[i + 1]} << 32 : 0);
    const Operand hit =
        emit_.value(bytes == 8 ? "setp.eq.u64" : "setp.eq.u32", {selector, Operand::value(literal & mask)});
    const auto same_target =
        std::find_if(cases.begin(), cases.end(), [&](const auto& c) { return c.first == to; });
    if (same_target == cases.end())
      cases.push_back({to, hit});
    else
      same_target->second = emit_.value("or.pred", {same_target->second, hit});
  }
  for (const auto& [to, predicate] : cases) {
    if (is_constant(predicate, 0)) continue;
    if (is_constant(predicate, 1)) return go(b, to);
    emit_.branch_if(predicate, true, edge(b, to));
    emit_.place(emit_.new_block(fmt::format("case_{}_{}", cfg_.block(b).label, to)));
  }
  go(b, otherwise);
}

// Returns the virtual block where the edge enters: the top of the iteration for back edges, the join of the
// innermost construct that holds `from` and ends at `to`, or the block after the joins.
BlockId ControlFlow::target(uint32_t from, uint32_t to) const {
  const Parts& parts = parts_[to];
  if (parts.top != kNoBlock && cfg_.dominates(to, from)) return parts.top;
  for (const auto& [construct, id] : parts.joins)
    if (cfg_.contains(construct, from)) return id;
  return parts.after_joins();
}

std::vector<Copy> ControlFlow::copies(uint32_t from, uint32_t to) {
  std::vector<Copy> result;
  for (const Instruction& phi : cfg_.block(to).code) {
    if (phi.op != spv::Op::OpPhi) break;
    if (is_place(phi.type)) continue;
    for (size_t i = 0; i + 1 < phi.operands.size(); i += 2) {
      if (phi.operands[i + 1] != cfg_.block(from).label) continue;
      const Operands from_parts = lowering_.value(phi.operands[i]);
      const Operands to_parts = lowering_.value(phi.result);
      for (size_t part = 0; part < to_parts.size(); ++part)
        if (!same(to_parts[part], from_parts[part]))
          result.push_back(
              {to_parts[part].reg, lowering_.program().registers[to_parts[part].reg], from_parts[part]});
      break;
    }
  }
  return result;
}

// Emits parallel copies one after the other. A copy may run once no other copy still reads its destination; a
// cycle is broken by saving one destination.
void ControlFlow::copy_all(std::vector<Copy> pending) {
  const auto is_read = [&](VirtualRegister r) {
    return std::any_of(pending.begin(), pending.end(), [&](const Copy& c) {
      return c.from.kind == Operand::Kind::Register && c.from.reg == r;
    });
  };
  while (!pending.empty()) {
    const auto free =
        std::find_if(pending.begin(), pending.end(), [&](const Copy& c) { return !is_read(c.to); });
    if (free != pending.end()) {
      const Copy copy = *free;
      pending.erase(free);
      emit_.copy(copy.to, copy.c, copy.from);
      continue;
    }
    const Copy& first = pending.front();
    const Operand saved = Operand::of(lowering_.program().new_register(first.c));
    const VirtualRegister overwritten = first.to;
    emit_.copy(saved.reg, first.c, Operand::of(overwritten));
    for (Copy& c : pending)
      if (c.from.kind == Operand::Kind::Register && c.from.reg == overwritten) c.from = saved;
  }
}

void ControlFlow::go(uint32_t from, uint32_t to) {
  copy_all(copies(from, to));
  emit_.branch(target(from, to));
}

// Returns the target of a branch that does not end its block: the destination itself, or a new block with the
// copies of the edge.
BlockId ControlFlow::edge(uint32_t from, uint32_t to) {
  if (copies(from, to).empty()) return target(from, to);
  edges_.push_back(
      {emit_.new_block(fmt::format("edge_{}_{}", cfg_.block(from).label, cfg_.block(to).label)), from, to});
  return edges_.back().block;
}

void ControlFlow::place_edges() {
  for (const Edge& e : edges_) {
    emit_.place(e.block);
    go(e.from, e.to);
  }
  edges_.clear();
}

}  // namespace

void lower_control(ModuleLowering& lowering) {
  ControlFlow(lowering).run();
}

}  // namespace glint::frontend
