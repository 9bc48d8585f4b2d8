// Places what a kernel declares: its parameters, and variables of the module and of functions.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fmt/format.h>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {
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

// Collects the names in a body, and places the shared variables declared there.
void KernelLowering::collect_names(const std::vector<Statement>& list, std::set<std::string>& used) {
  const auto visit = [&](const Operand& o, auto&& self) -> void {
    used.insert(o.name);
    for (const Operand& part : o.parts) self(part, self);
  };
  for (const Statement& s : list) {
    for (const Operand& o : s.instruction.operands) visit(o, visit);
    if (s.kind == Statement::Kind::Declaration && s.declaration.space == VariableSpace::Shared &&
        !s.declaration.is_extern)
      place_shared({&s.declaration});
    collect_names(s.body, used);
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
  collect_names(entry_.body, used);
  for (const Function& f : module_.functions)
    if (&f != &entry_ && graph_.reached().contains(&f)) collect_names(f.body, used);
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
    const bool is_function = functions_.contains(value.symbol);
    const bool is_pointer = !value.symbol.empty() && !is_function;
    const uint64_t number = is_function ? graph_.number_of(value.symbol) : is_pointer ? 0 : value.value;
    if (is_pointer) variable.pointers.push_back({at, value.symbol, value.value});
    for (size_t i = 0; i < element; ++i) variable.initial.push_back(std::byte(number >> (8 * i)));
  }
  if (variable.initial.size() > variable.bytes)
    error(d.position, fmt::format("'{}' has {} bytes, but values for {}", d.name, variable.bytes,
                                  variable.initial.size()));
  kernel_.variables.push_back(std::move(variable));
  return symbol;
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

}  // namespace glint::frontend::ptx
