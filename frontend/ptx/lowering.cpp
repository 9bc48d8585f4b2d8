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
      unsupported_(unsupported) {
  for (const Declaration& d : module.variables) module_variables_[d.name] = &d;
  for (const Function& f : module.functions) functions_[f.name] = &f;
  program_.name = entry.name;
  program_.stage = isa::Stage::Compute;
  program_.files = {module.file};
}

VirtualProgram KernelLowering::run() {
  if (const auto& c = entry_.required_cluster; c && uint64_t{(*c)[0]} * (*c)[1] * (*c)[2] != 1)
    no_support(entry_.position,
               fmt::format("not supported: a cluster of {} x {} x {} blocks (.reqnctapercluster)", (*c)[0],
                           (*c)[1], (*c)[2]));
  scopes_.push_back({{}, {}, true});
  place_parameters();
  place_variables();
  line_.line = uint32_t(entry_.position.line);
  const BlockId first = new_block("");
  const BlockId body = new_block(entry_.name);
  begin(first);
  end_goto(body);
  begin(body);
  predeclare_labels(entry_.body);
  statements(entry_.body);
  if (block_ != kNoBlock) end_exit();
  if (errors_.has_errors() || unsupported_.has_errors()) return std::move(program_);
  for (const DraftBlock& block : draft_.blocks)
    for (BlockId next : block.successors())
      if (std::find(draft_.layout.begin(), draft_.layout.end(), next) == draft_.layout.end())
        error(entry_.position, fmt::format("label '{}' is the target of a branch but is not defined",
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
  kernel_.constant_bank_bytes = std::max(isa::kConstantBankBytes, isa::kPushConstantOffset + bank_bytes_);
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

namespace {

uint64_t aligned(uint64_t at, uint64_t align) {
  return align ? (at + align - 1) / align * align : at;
}

}  // namespace

void KernelLowering::place_parameters() {
  uint64_t at = 0;
  for (const Declaration& d : entry_.parameters) {
    at = aligned(at, d.alignment());
    Symbol symbol;
    symbol.kind = Symbol::Kind::Variable;
    symbol.type = d.type;
    symbol.space = VariableSpace::Param;
    symbol.address = at;
    scopes_.front().names[d.name] = symbol;
    kernel_.parameters.push_back(
        {d.name, uint32_t(at), uint32_t(d.bytes()), fmt::format("{}{}", d.type.kind, d.type.bits)});
    at += d.bytes();
  }
  bank_bytes_ = uint32_t(aligned(at, 8));
}

// Collects the names in the kernel and in the functions that it may call, and the shared variables declared
// there.
void KernelLowering::collect_names(const std::vector<Statement>& list, std::set<std::string>& used,
                                   std::set<const Function*>& seen) {
  const auto visit = [&](const Operand& o, auto&& self) -> void {
    used.insert(o.name);
    for (const Operand& part : o.parts) self(part, self);
    const auto f = functions_.find(o.name);
    if (f != functions_.end() && seen.insert(f->second).second) collect_names(f->second->body, used, seen);
  };
  for (const Statement& s : list) {
    for (const Operand& o : s.instruction.operands) visit(o, visit);
    if (s.kind == Statement::Kind::Declaration && s.declaration.space == VariableSpace::Shared &&
        !s.declaration.is_extern)
      place_shared({&s.declaration});
    collect_names(s.body, used, seen);
  }
}

void KernelLowering::place_shared(const std::vector<const Declaration*>& declarations) {
  for (const Declaration* d : declarations) {
    const uint64_t at = aligned(static_shared_, d->alignment());
    shared_[d] = at;
    static_shared_ = at + d->bytes();
  }
}

void KernelLowering::place_variables() {
  std::set<std::string> used;
  std::set<const Function*> seen;
  collect_names(entry_.body, used, seen);
  // A variable to which a used variable points is used, too.
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& [name, d] : module_variables_)
      if (used.contains(name))
        for (const Initializer& value : d->initial)
          grew |= !value.symbol.empty() && used.insert(value.symbol).second;
  }
  std::vector<const Declaration*> open;
  for (const Declaration& d : module_.variables) {
    if (!used.contains(d.name) || d.space != VariableSpace::Shared) continue;
    if (d.is_extern || d.has_open_dimension) {
      open.push_back(&d);
    } else {
      place_shared({&d});
    }
  }
  // Dynamic shared memory begins after the static part, and all of its names refer to that place.
  uint64_t align = 16;
  for (const Declaration* d : open) align = std::max<uint64_t>(align, d->alignment());
  if (!open.empty()) static_shared_ = aligned(static_shared_, align);
  for (const Declaration* d : open) shared_[d] = static_shared_;
  for (const Declaration& d : module_.variables)
    if (used.contains(d.name)) placed_[d.name] = module_variable(d);
}

Symbol KernelLowering::module_variable(const Declaration& d) {
  Symbol symbol;
  symbol.kind = Symbol::Kind::Variable;
  symbol.type = d.type;
  symbol.space = d.space;
  if (d.space == VariableSpace::Shared) {
    symbol.address = shared_.at(&d);
    return symbol;
  }
  if (d.is_extern)
    no_support(
        d.position,
        fmt::format("variable '{}' belongs to another module, and Glint does not link modules", d.name));
  ModuleVariable variable;
  variable.name = d.name;
  variable.bytes = d.bytes();
  variable.is_constant = d.space == VariableSpace::Const;
  bank_bytes_ = uint32_t(aligned(bank_bytes_, variable.is_constant ? d.alignment() : 8));
  symbol.address = bank_bytes_;
  variable.offset = isa::kPushConstantOffset + bank_bytes_;
  bank_bytes_ += variable.is_constant ? uint32_t(d.bytes()) : 8;
  const size_t element = d.type.bits / 8;
  for (const Initializer& value : d.initial) {
    const size_t at = variable.initial.size();
    if (!value.symbol.empty()) variable.pointers.push_back({at, value.symbol, value.value});
    for (size_t i = 0; i < element; ++i)
      variable.initial.push_back(value.symbol.empty() ? std::byte(value.value >> (8 * i)) : std::byte{});
  }
  if (variable.initial.size() > variable.bytes)
    error(d.position, fmt::format("'{}' has {} bytes, but values for {}", d.name, variable.bytes,
                                  variable.initial.size()));
  kernel_.variables.push_back(std::move(variable));
  return symbol;
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
    if (s.kind != Statement::Kind::Label && s.kind != Statement::Kind::Targets) continue;
    Symbol symbol;
    symbol.kind = s.kind == Statement::Kind::Label ? Symbol::Kind::Label : Symbol::Kind::Targets;
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
        break;
      case Statement::Kind::Pragma:
        if (block_ != kNoBlock && s.label.find("nounroll") != std::string::npos)
          draft_.blocks[block_].may_unroll = false;
        break;
    }
  }
}

void KernelLowering::declare(const Declaration& d) {
  Symbol symbol;
  symbol.type = d.type;
  symbol.space = d.space;
  if (d.space == VariableSpace::Register) {
    if (d.type.bits > 64)
      return no_support(d.position, fmt::format("not supported: registers of {} bits", d.type.bits));
    if (d.range) {
      scopes_.back().ranges.push_back(&d);
      return;
    }
    if (d.vector > 1)
      for (uint32_t i = 0; i < d.vector; ++i) symbol.elements.push_back(temporary(class_of(d.type)));
    else
      symbol.reg = temporary(class_of(d.type));
  } else if (d.space == VariableSpace::Param) {
    symbol.kind = Symbol::Kind::Parameter;
    for (uint64_t i = 0; i < (d.bytes() + 3) / 4; ++i)
      symbol.elements.push_back(temporary(RegisterClass::B32));
  } else {
    symbol.kind = Symbol::Kind::Variable;
    if (d.space == VariableSpace::Local) {
      symbol.address = aligned(program_.local_bytes, d.alignment());
      if (symbol.address + d.bytes() > kMostLocalBytes)
        return no_support(d.position,
                          fmt::format("not supported: '{}': more than {} bytes of local memory of one thread",
                                      d.name, kMostLocalBytes));
      program_.local_bytes = uint32_t(aligned(symbol.address + d.bytes(), 4));
    } else if (d.space == VariableSpace::Shared && !d.is_extern) {
      symbol.address = shared_.at(&d);
    } else {
      return no_support(
          d.position,
          fmt::format("not supported: '{}': global, constant and extern variables inside a function",
                      d.name));
    }
  }
  scopes_.back().names[d.name] = symbol;
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
  if (lower_control(inst) || lower_special(inst) || lower_async(inst) || lower_video(inst)) return;
  lower_generic(inst);
}

}  // namespace glint::frontend::ptx
