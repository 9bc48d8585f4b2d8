// Lowers names, blocks and statements.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/lowering.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <fmt/format.h>

#include "frontend/backend/liveness.h"
#include "frontend/ptx/fields.h"
#include "frontend/ptx/machine.h"
#include "frontend/ptx/unroll.h"
#include "frontend/ptx/unsupported.h"

namespace glint::frontend::ptx {

RegisterClass class_of(const Type& type) {
  return type.kind == 'p'  ? RegisterClass::Predicate
         : type.bits == 64 ? RegisterClass::B64
                           : RegisterClass::B32;
}

KernelLowering::KernelLowering(const Module& module, const Function& entry, const PtxOptions& options,
                               Kernel& kernel, Diagnostics& errors, Diagnostics& unsupported)
    : module_(module),
      entry_(entry),
      options_(options),
      kernel_(kernel),
      errors_(errors),
      unsupported_(unsupported),
      graph_(module, entry) {
  for (const Declaration& d : module.variables) module_variables_[d.name] = &d;
  for (const Function& f : module.functions) functions_[f.name] = &f;
}

std::vector<VirtualProgram> KernelLowering::run() {
  if (const auto& c = entry_.required_cluster; c && uint64_t{(*c)[0]} * (*c)[1] * (*c)[2] != 1)
    no_support(entry_.position,
               fmt::format("not supported: a cluster of {} x {} x {} blocks (.reqnctapercluster)", (*c)[0],
                           (*c)[1], (*c)[2]));
  scopes_.push_back({{}, {}, true});
  place_parameters();
  place_variables();
  std::vector<VirtualProgram> out;
  out.push_back(lower_body(entry_));
  for (const Function* f : graph_.called()) {
    scopes_ = {{{}, {}, true}};
    out.push_back(lower_body(*f));
  }
  kernel_.constant_bank_bytes = std::max(isa::kConstantBankBytes, isa::kPushConstantOffset + bank_bytes_);
  return out;
}

VirtualProgram KernelLowering::lower_body(const Function& f) {
  program_ = {};
  program_.name = f.name;
  program_.stage = isa::Stage::Compute;
  program_.files = {module_.file};
  draft_ = {};
  free_ = {};
  line_.line = uint32_t(f.position.line);
  const BlockId first = new_block("");
  const BlockId body = new_block(f.name);
  begin(first);
  end_goto(body);
  begin(body);
  if (f.is_entry) {
    predeclare_labels(f.body);
    statements(f.body);
    end_exit();
  } else {
    lower_function(f);
  }
  if (errors_.has_errors() || unsupported_.has_errors()) return std::move(program_);
  for (const DraftBlock& block : draft_.blocks)
    for (BlockId next : block.successors())
      if (std::find(draft_.layout.begin(), draft_.layout.end(), next) == draft_.layout.end())
        error(f.position, fmt::format("label '{}' is the target of a branch but is not defined",
                                      draft_.blocks[next].name));
  if (errors_.has_errors()) return std::move(program_);
  keep_yields_in_loops(draft_);
  if (options_.contract) contract(draft_, free_, program_);
  if (options_.shape) {
    expand_fields(draft_, program_);
    unroll_loops(draft_, program_);
    exit_at_branches(draft_);
  }
  add_reconvergence(draft_);
  program_.blocks = lay_out(std::move(draft_));
  zero_what_nobody_wrote(program_);
  if (options_.shape) shape_for_machine(program_);
  enclose_calls(program_);
  return std::move(program_);
}

// Sets registers that nothing has written to 0, because the backend wants a definition on every path and PTX
// leaves them undefined. Choice: they read as 0 or false.
void KernelLowering::zero_what_nobody_wrote(VirtualProgram& program) {
  std::vector<VirtualInst> zeros;
  const VirtualOperand zero = VirtualOperand::value(0);
  find_liveness(program).in.front().for_each([&](VirtualRegister r) {
    VirtualInst inst;
    inst.line = line_;
    const RegisterClass c = program.registers[r];
    inst.op = isa::op_index(c == RegisterClass::Predicate ? "setp.ne.u32"
                            : c == RegisterClass::B64     ? "mov.b64"
                                                          : "mov.b32");
    inst.operands = {VirtualOperand::of(r), zero};
    if (c == RegisterClass::Predicate) inst.operands.push_back(zero);
    zeros.push_back(std::move(inst));
  });
  std::vector<VirtualInst>& code = program.blocks.front().code;
  code.insert(code.begin(), zeros.begin(), zeros.end());
}

BlockId KernelLowering::new_block(const std::string& name) {
  DraftBlock block;
  block.name = name;
  draft_.blocks.push_back(std::move(block));
  return BlockId(draft_.blocks.size() - 1);
}

void KernelLowering::begin(BlockId block) {
  draft_.layout.push_back(block);
  block_ = block;
}

void KernelLowering::end_goto(BlockId next) {
  if (block_ == kNoBlock) return;
  DraftBlock& b = draft_.blocks[block_];
  b.end = DraftBlock::End::Goto;
  b.next = next;
  b.line = line_;
  block_ = kNoBlock;
}

void KernelLowering::end_branch(VirtualRegister condition, bool negate, BlockId taken, BlockId next,
                                bool uniform) {
  DraftBlock& b = draft_.blocks[block_];
  b.end = DraftBlock::End::Branch;
  b.condition = condition;
  b.negate = negate;
  b.uniform = uniform;
  b.taken = taken;
  b.next = next;
  b.line = line_;
  block_ = kNoBlock;
}

void KernelLowering::end_exit() {
  if (block_ == kNoBlock) return;
  draft_.blocks[block_].end = DraftBlock::End::Exit;
  draft_.blocks[block_].line = line_;
  block_ = kNoBlock;
}

void KernelLowering::predeclare_labels(const std::vector<Statement>& list) {
  for (const Statement& s : list) {
    using Kind = Statement::Kind;
    const bool is_list = s.kind == Kind::Targets || s.kind == Kind::CallTargets;
    if (s.kind != Kind::Label && s.kind != Kind::Prototype && !is_list) continue;
    Symbol symbol;
    symbol.kind = s.kind == Kind::Label ? Symbol::Kind::Label
                  : is_list             ? Symbol::Kind::Targets
                                        : Symbol::Kind::Prototype;
    symbol.signature = &s.signature;
    if (symbol.kind == Symbol::Kind::Label) symbol.block = new_block(s.label);
    symbol.targets = &s.targets;
    if (!scopes_.back().names.emplace(s.label, symbol).second)
      error(s.position, fmt::format("label '{}' is defined twice", s.label));
  }
}

void KernelLowering::statements(const std::vector<Statement>& list) {
  for (const Statement& s : list) {
    switch (s.kind) {
      case Statement::Kind::Label: {
        const BlockId block = scopes_.back().names.at(s.label).block;
        line_.line = uint32_t(s.position.line);
        end_goto(block);
        begin(block);
        break;
      }
      case Statement::Kind::Declaration:
        declare(s.declaration);
        break;
      case Statement::Kind::Scope:
        scopes_.emplace_back();
        predeclare_labels(s.body);
        statements(s.body);
        scopes_.pop_back();
        break;
      case Statement::Kind::Instruction:
        if (block_ == kNoBlock) begin(new_block(""));  // unreachable: after a branch and without a label
        lower(s.instruction);
        break;
      case Statement::Kind::Targets:
      case Statement::Kind::CallTargets:
      case Statement::Kind::Prototype:
        break;
      case Statement::Kind::Pragma:
        if (block_ != kNoBlock && s.label.find("nounroll") != std::string::npos)
          draft_.blocks[block_].may_unroll = false;
        break;
    }
  }
}

// Makes a register of a range when it is first named, such as %r7 of `.reg .b32 %r<10>`.
Symbol* KernelLowering::find_range(Scope& scope, const std::string& name) {
  for (const Declaration* d : scope.ranges) {
    if (!name.starts_with(d->name) || name.size() == d->name.size()) continue;
    const std::string digits = name.substr(d->name.size());
    if (!std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); }) ||
        digits.size() > 9)
      continue;
    if ((digits.size() > 1 && digits[0] == '0') || std::stoul(digits) >= d->range) continue;
    Symbol symbol;
    symbol.type = d->type;
    symbol.reg = temporary(class_of(d->type));
    return &scope.names.emplace(name, symbol).first->second;
  }
  return nullptr;
}

const Symbol* KernelLowering::find(const std::string& name) {
  for (size_t i = scopes_.size(); i-- > 0;) {
    if (const auto at = scopes_[i].names.find(name); at != scopes_[i].names.end()) return &at->second;
    if (const Symbol* symbol = find_range(scopes_[i], name)) return symbol;
    if (scopes_[i].is_function) break;
  }
  const auto at = placed_.find(name);
  return at == placed_.end() ? nullptr : &at->second;
}

void KernelLowering::lower(const Instruction& inst) {
  line_.line = uint32_t(inst.position.line);
  guard_ = kNoRegister;
  guard_negate_ = inst.guard_negated;
  if (!inst.guard.empty()) guard_ = predicate_register(inst.guard, inst.position);
  if (const std::string part = unsupported_part(inst.words); !part.empty())
    return no_support(inst.position,
                      fmt::format("not supported: '{}', which belongs to {}", joined(inst.words), part));
  if (options_.check_types) check_types(inst);
  if (lower_control(inst) || lower_special(inst) || lower_async(inst) || lower_video(inst) ||
      lower_tensor(inst) || lower_image(inst))
    return;
  lower_generic(inst);
}

}  // namespace glint::frontend::ptx
