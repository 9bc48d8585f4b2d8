// Writes one function of a tree as SPIR-V: blocks, the SSA form of its variables, statements.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "tests/torture/spirv_writer.h"
#include "tests/torture/tree.h"

namespace glint::test::torture {

struct ModuleIds {
  Id inputs, results, own, global_id, local_id, slots;
  std::vector<Id> functions;
};

struct Phi {
  Id id;
  uint32_t variable;
  Words operands;
};

// Holds the SSA form while it is written, by Braun et al., "Simple and Efficient Construction of Static
// Single Assignment Form" (2013). Phis that only pass on one value are kept.
struct BlockCode {
  Id label = 0;
  bool is_sealed = true, is_closed = false;  // all predecessors are known; ends with a terminator
  std::vector<BlockCode*> predecessors;
  std::map<uint32_t, Id> values;
  std::vector<Phi> phis;
  std::vector<size_t> open_phis;
  Words code;
};

// Says where exits go from here.
struct Targets {
  BlockCode *loop_merge = nullptr, *loop_continue = nullptr, *nearest_merge = nullptr;
  BlockCode *leave = nullptr, *next_case = nullptr;
};

class FunctionWriter {
 public:
  FunctionWriter(SpirvWriter& writer, ModuleIds& ids, const ProgramTree& program, size_t number)
      : w_(writer),
        ids_(ids),
        program_(program),
        tree_(program.functions[number]),
        is_entry_(number + 1 == program.functions.size()) {}

  Id run();

 private:
  Id word_type() { return w_.int_type(); }
  Id type_of(Sort sort) {
    return sort == Sort::Word ? word_type() : sort == Sort::Bool ? w_.bool_type() : w_.float_type();
  }
  Id op(spv::Op what, Id type, Words operands) {
    const Id id = w_.new_id();
    operands.insert(operands.begin(), {type, id});
    append(here_->code, what, operands);
    return id;
  }
  Id load_from(spv::StorageClass storage, Id base, Words indices) {
    return op(spv::Op::OpLoad, word_type(), {chain(storage, base, std::move(indices))});
  }
  Id chain(spv::StorageClass storage, Id base, Words indices) {
    indices.insert(indices.begin(), base);
    return op(spv::Op::OpAccessChain, w_.pointer_to(storage, word_type()), indices);
  }
  void store(Id pointer, Id value) { append(here_->code, spv::Op::OpStore, {pointer, value}); }
  Id own_word(Id index) {
    const Id first = op(spv::Op::OpIMul, word_type(), {lane_, w_.word(kOwnWords)});
    return chain(spv::StorageClass::StorageBuffer, ids_.own,
                 {w_.word(0), op(spv::Op::OpIAdd, word_type(), {first, masked(index, kOwnWords - 1)})});
  }
  Id masked(Id x, uint32_t mask) { return op(spv::Op::OpBitwiseAnd, word_type(), {x, w_.word(mask)}); }

  BlockCode* new_block(bool sealed = true) {
    blocks_.emplace_back();
    blocks_.back().label = w_.new_id();
    blocks_.back().is_sealed = sealed;
    return &blocks_.back();
  }
  void begin(BlockCode* block) {
    here_ = block;
    order_.push_back(block);
  }
  // Does what begin() does for a block behind a construct, at which nothing may arrive.
  void begin_merge(BlockCode* block, bool write_dead_code) {
    begin(block);
    if (block->predecessors.empty() && !write_dead_code) end(spv::Op::OpUnreachable, {});
  }
  void end(spv::Op what, const Words& operands) {
    append(here_->code, what, operands);
    here_->is_closed = true;
  }
  void edge(BlockCode* to) {
    if (std::find(to->predecessors.begin(), to->predecessors.end(), here_) == to->predecessors.end())
      to->predecessors.push_back(here_);
  }
  void branch(BlockCode* to) {
    if (here_->is_closed) return;
    edge(to);
    end(spv::Op::OpBranch, {to->label});
  }
  void branch_if(Id condition, BlockCode* yes, BlockCode* no) {
    edge(yes);
    edge(no);
    end(spv::Op::OpBranchConditional, {condition, yes->label, no->label});
  }
  void merge(BlockCode* at) { append(here_->code, spv::Op::OpSelectionMerge, {at->label, 0}); }
  void loop_merge(BlockCode* at, BlockCode* target) {
    append(here_->code, spv::Op::OpLoopMerge, {at->label, target->label, 0});
  }

  Id read(uint32_t variable, BlockCode* block);
  void fill(BlockCode* block, size_t phi);
  void seal(BlockCode* block);
  Id get(uint32_t variable) {
    if (memory_[variable])
      return op(spv::Op::OpLoad, type_of(tree_.variables[variable]), {memory_[variable]});
    return read(variable, here_);
  }
  void set(uint32_t variable, Id value) {
    if (memory_[variable]) return store(memory_[variable], value);
    here_->values[variable] = value;
  }

  Id value(const Expr& e);
  Id binary(const Expr& e);
  void list(const std::vector<Stmt>& stmts, const Targets& targets);
  void statement(const Stmt& s, const Targets& targets);
  void leave_function(Id result);
  BlockCode* exit_target(Stmt::Kind kind, const Targets& t);
  void branch_statement(const Stmt& s, Targets targets);
  void choice(const Stmt& s, Targets targets);
  void loop(const Stmt& s, Targets targets);
  void single_block_loop(const Stmt& s);
  Id goes_on(const Stmt& s);
  void exchange(const Stmt& s);
  void count(uint32_t variable) {
    set(variable, op(spv::Op::OpIAdd, word_type(), {get(variable), w_.word(1)}));
  }

  SpirvWriter& w_;
  ModuleIds& ids_;
  const ProgramTree& program_;
  const FunctionTree& tree_;
  const bool is_entry_;
  std::deque<BlockCode> blocks_;
  std::vector<BlockCode*> order_;
  BlockCode* here_ = nullptr;
  std::vector<Id> memory_;  // memory of variables that are not phis
  Id lane_ = 0, elements_ = 0;
};

}  // namespace glint::test::torture
