// Lowers operands: registers, literals, special registers, addresses, and the conversions between widths.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <fmt/format.h>

#include "frontend/ptx/lowering.h"
#include "frontend/ptx/unsupported.h"
#include "isa/text.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

namespace {

bool is_wide(OperandKind kind) {
  return kind == OperandKind::Src64 || kind == OperandKind::Dst64 || kind == OperandKind::Address64;
}

}  // namespace

std::vector<const Operand*> parts_of(const Operand& o) {
  if (o.kind != Operand::Kind::Vector) return {&o};
  std::vector<const Operand*> out;
  for (const Operand& part : o.parts) out.push_back(&part);
  return out;
}

VirtualInst& KernelLowering::emit(int op, std::vector<VirtualOperand> operands, int64_t imm) {
  VirtualInst inst;
  inst.op = uint16_t(op);
  inst.operands = std::move(operands);
  inst.imm = int32_t(imm);
  inst.guard = guard_;
  inst.guard_negate = guard_ != kNoRegister && guard_negate_;
  inst.line = line_;
  std::vector<VirtualInst>& code = draft_.blocks[block_].code;
  code.push_back(std::move(inst));
  return code.back();
}

VirtualInst& KernelLowering::compute(std::string_view op, std::vector<VirtualOperand> operands, int64_t imm) {
  VirtualInst& inst = emit(isa::op_index(op), std::move(operands), imm);
  inst.guard = kNoRegister;
  inst.guard_negate = false;
  return inst;
}

VirtualOperand KernelLowering::compute32(std::string_view op, std::vector<VirtualOperand> sources) {
  const VirtualOperand to = VirtualOperand::of(temporary(RegisterClass::B32));
  sources.insert(sources.begin(), to);
  compute(op, std::move(sources));
  return to;
}

VirtualOperand KernelLowering::compute64(std::string_view op, std::vector<VirtualOperand> sources) {
  const VirtualOperand to = VirtualOperand::of(temporary(RegisterClass::B64));
  sources.insert(sources.begin(), to);
  compute(op, std::move(sources));
  return to;
}

VirtualOperand KernelLowering::compute_predicate(std::string_view op, std::vector<VirtualOperand> sources) {
  const VirtualOperand to = VirtualOperand::of(temporary(RegisterClass::Predicate));
  sources.insert(sources.begin(), to);
  compute(op, std::move(sources));
  return to;
}

VirtualOperand KernelLowering::widened(VirtualOperand narrow, bool with_sign) {
  if (narrow.kind == VirtualOperand::Kind::Constant)
    return VirtualOperand::value(with_sign ? uint64_t(int64_t(int32_t(narrow.constant)))
                                           : uint64_t(uint32_t(narrow.constant)));
  return compute64(with_sign ? "cvt.s64.s32" : "cvt.u64.u32", {narrow});
}

const Symbol* KernelLowering::register_symbol(const Operand& o) {
  const Symbol* symbol = find(o.name);
  if (!symbol) {
    error(o.position, fmt::format("'{}' is not declared", o.name));
  } else if (symbol->kind != Symbol::Kind::Register) {
    error(o.position, fmt::format("'{}' is not a register", o.name));
    return nullptr;
  }
  return symbol;
}

VirtualRegister KernelLowering::predicate_register(const std::string& name, TextPosition position) {
  Operand o;
  o.name = name;
  o.position = position;
  const Symbol* symbol = register_symbol(o);
  if (!symbol) return temporary(RegisterClass::Predicate);
  if (symbol->type.kind == 'p') return symbol->reg;
  error(position, fmt::format("'{}' is not a predicate", name));
  return temporary(RegisterClass::Predicate);
}

VirtualOperand KernelLowering::predicate_source(const Operand& o) {
  if (o.kind == Operand::Kind::Integer) {
    const VirtualOperand zero = VirtualOperand::value(0);
    return compute_predicate("setp.ne.u32", {VirtualOperand::value(o.value != 0), zero});
  }
  if (o.kind != Operand::Kind::Name) {
    error(o.position, "expected a predicate");
    return VirtualOperand::of(temporary(RegisterClass::Predicate));
  }
  const VirtualOperand p = VirtualOperand::of(predicate_register(o.name, o.position));
  return o.negated ? compute_predicate("not.pred", {p}) : p;
}

// Returns the bits of a number as the instruction's type reads them.
VirtualOperand KernelLowering::literal(const Operand& o, bool wide, const Type& type) {
  if (o.kind == Operand::Kind::Integer) return VirtualOperand::value(wide ? o.value : uint32_t(o.value));
  if (type.bits == 16 && o.kind == Operand::Kind::Float64)
    no_support(o.position, "not supported: decimal constants of 16-bit floats: write their bits");
  if (o.kind == Operand::Kind::Float32)
    return VirtualOperand::value(
        wide ? std::bit_cast<uint64_t>(double(std::bit_cast<float>(uint32_t(o.value)))) : o.value);
  return VirtualOperand::value(wide ? o.value
                                    : std::bit_cast<uint32_t>(float(std::bit_cast<double>(o.value))));
}

VirtualOperand KernelLowering::special_source(const Operand& o, bool wide, bool& found) {
  using isa::Special;
  found = true;
  const std::string name = o.element.empty() ? o.name : o.name + "." + o.element;
  const auto pair = [&](Special low, Special high) {
    const VirtualOperand a = VirtualOperand::of(low), b = VirtualOperand::of(high);
    return wide ? compute64("pack.b64", {a, b}) : a;
  };
  if (name == "%clock64" || (name == "%clock" && wide)) return pair(Special::Clock, Special::ClockHi);
  if (name == "%globaltimer") return pair(Special::GlobalTimerLo, Special::GlobalTimerHi);
  // Model: a cluster is one block.
  if (name.starts_with("%cluster_ctaid.") || name == "%cluster_ctarank" || name == "%is_explicit_cluster")
    return VirtualOperand::value(0);
  if (name.starts_with("%cluster_nctaid.") || name == "%cluster_nctarank") return VirtualOperand::value(1);
  const Special special = isa::find_special(name);
  found = special != Special::Count && special < Special::Payload;
  if (!found) return VirtualOperand::value(0);
  return wide ? widened(VirtualOperand::of(special), false) : VirtualOperand::of(special);
}

VirtualOperand KernelLowering::address_of(const Symbol& symbol, int64_t offset, bool wide) {
  if (symbol.space == VariableSpace::Local && program_.function) {
    const VirtualOperand at =
        compute32("add.u32", {VirtualOperand::stack_pointer(),
                              VirtualOperand::value(uint32_t(symbol.address + uint64_t(offset)))});
    return wide ? widened(at, false) : at;
  }
  if (symbol.space != VariableSpace::Global) {
    const uint64_t base = symbol.space == VariableSpace::Const ? isa::kPushConstantOffset : 0;
    return VirtualOperand::value(base + symbol.address + uint64_t(offset));
  }
  const VirtualOperand to = VirtualOperand::of(temporary(RegisterClass::B64));
  compute("ld.param.b64", {to, VirtualOperand::value(0)}, int64_t(symbol.address));
  const VirtualOperand whole =
      offset ? compute64("add.u64", {to, VirtualOperand::value(uint64_t(offset))}) : to;
  return wide ? whole : compute32("cvt.u32.u64", {whole});
}

VirtualOperand KernelLowering::name_source(const Operand& o, bool wide) {
  const Symbol* symbol = find(o.name);
  if (symbol && symbol->kind == Symbol::Kind::Register && symbol->elements.empty() &&
      is_part_selector(o.element)) {
    no_support(o.position,
               fmt::format("not supported: '{}.{}', a byte or half of a register in a video instruction",
                           o.name, o.element));
    return VirtualOperand::value(0);
  }
  // `%tid.x` is not a part of a scalar register named %tid.
  if (symbol && symbol->kind == Symbol::Kind::Register && symbol->elements.empty() && !o.element.empty())
    symbol = nullptr;
  if (!symbol) {
    bool found = false;
    const VirtualOperand special = special_source(o, wide, found);
    if (found) return special;
    if (functions_.contains(o.name)) return VirtualOperand::value(graph_.number_of(o.name));
    if (o.name.starts_with("%envreg")) {
      no_support(
          o.position,
          fmt::format("not supported: '{}', by which cooperative groups wait for the whole grid", o.name));
      return VirtualOperand::value(0);
    }
    error(o.position,
          fmt::format("'{}' is not declared", o.element.empty() ? o.name : o.name + "." + o.element));
    return VirtualOperand::value(0);
  }
  if (symbol->kind == Symbol::Kind::Variable) return address_of(*symbol, o.offset, wide);
  if (symbol->kind != Symbol::Kind::Register) {
    error(o.position, fmt::format("'{}' is not an operand of this instruction", o.name));
    return VirtualOperand::value(0);
  }
  if (symbol->type.kind == 'p') {
    error(o.position, fmt::format("'{}' is a predicate, but the instruction takes a number", o.name));
    return VirtualOperand::value(0);
  }
  VirtualRegister reg = symbol->reg;
  if (!symbol->elements.empty()) {
    const size_t n = std::string_view("xyzw").find(o.element.empty() ? "x" : o.element.substr(0, 1));
    reg = symbol->elements[n < symbol->elements.size() ? n : 0];
  }
  const VirtualOperand value = VirtualOperand::of(reg);
  const bool has_pair = class_of(symbol->type) == RegisterClass::B64;
  if (has_pair == wide) return value;
  return wide ? widened(value, symbol->type.kind == 's') : compute32("cvt.u32.u64", {value});
}

VirtualOperand KernelLowering::source(const Operand& o, OperandKind kind, const Type& type) {
  if (kind == OperandKind::SrcPred) return predicate_source(o);
  if (o.negated) error(o.position, "'!' is allowed only before predicates");
  switch (o.kind) {
    case Operand::Kind::Integer:
    case Operand::Kind::Float32:
    case Operand::Kind::Float64:
      return literal(o, is_wide(kind), type);
    case Operand::Kind::Name:
      return name_source(o, is_wide(kind));
    default:
      error(o.position, "expected a register or a number");
      return VirtualOperand::value(0);
  }
}

VirtualOperand KernelLowering::destination(const Operand& o, OperandKind kind, const Type& type) {
  const RegisterClass wanted = kind == OperandKind::DstPred ? RegisterClass::Predicate
                               : is_wide(kind)              ? RegisterClass::B64
                                                            : RegisterClass::B32;
  if (o.kind == Operand::Kind::Sink) return VirtualOperand::of(temporary(wanted));
  if (o.kind != Operand::Kind::Name) {
    error(o.position, "expected a register to write");
    return VirtualOperand::of(temporary(wanted));
  }
  const Symbol* symbol = register_symbol(o);
  if (!symbol) return VirtualOperand::of(temporary(wanted));
  VirtualRegister reg = symbol->reg;
  if (!symbol->elements.empty()) {
    const size_t n = std::string_view("xyzw").find(o.element.empty() ? "x" : o.element.substr(0, 1));
    reg = symbol->elements[n < symbol->elements.size() ? n : 0];
  }
  const RegisterClass has = class_of(symbol->type);
  if (has == wanted) return VirtualOperand::of(reg);
  const VirtualOperand value = VirtualOperand::of(temporary(wanted));
  if (has == RegisterClass::Predicate || wanted == RegisterClass::Predicate) {
    error(o.position, fmt::format("'{}' is {} predicate, but the result is {}", o.name,
                                  has == RegisterClass::Predicate ? "a" : "not a",
                                  wanted == RegisterClass::Predicate ? "a predicate" : "a number"));
    return value;
  }
  const char* op = has == RegisterClass::B32 ? "cvt.u32.u64"
                   : type.kind == 's'        ? "cvt.s64.s32"
                                             : "cvt.u64.u32";
  late_.push_back({isa::op_index(op), VirtualOperand::of(reg), value});
  return value;
}

void KernelLowering::finish_moves() {
  for (const LateMove& move : late_) emit(move.op, {move.to, move.from});
  late_.clear();
}

// Returns the base of `[base + offset]` and stores the displacement in `imm`.
VirtualOperand KernelLowering::address(const Operand& o, bool wide, int64_t& imm) {
  if (o.kind != Operand::Kind::Address || o.parts.size() != 1) {
    error(o.position, "expected an address such as [%rd1+4]");
    return VirtualOperand::value(0);
  }
  const Operand& base = o.parts.front();
  imm = o.offset;
  const Symbol* symbol = base.kind == Operand::Kind::Name ? find(base.name) : nullptr;
  VirtualOperand out;
  if (symbol && symbol->kind == Symbol::Kind::Variable) {
    out = address_of(*symbol, 0, wide);
  } else if (base.kind == Operand::Kind::Name) {
    out = name_source(base, wide);
  } else {
    out = literal(base, true, {'u', 64});
  }
  if (imm != int32_t(imm)) {
    const VirtualOperand far = VirtualOperand::value(uint64_t(imm));
    out = wide ? compute64("add.u64", {out, far}) : compute32("add.u32", {out, far});
    imm = 0;
  }
  // The row adds a displacement, so a constant address becomes base 0 and a displacement where the row allows
  // it.
  if (out.kind == VirtualOperand::Kind::Constant) {
    const uint64_t whole = out.constant + uint64_t(imm);
    if (!wide && whole == uint64_t(int32_t(whole))) {
      imm = int64_t(whole);
      return VirtualOperand::value(0);
    }
    return wide ? compute64("mov.b64", {out}) : compute32("mov.b32", {out});
  }
  return out;
}

}  // namespace glint::frontend::ptx
