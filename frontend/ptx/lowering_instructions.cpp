// Lowers instructions. Most of them are one row of the table; some need several rows or other operands.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fmt/format.h>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

namespace {

constexpr const char* kCarry = "%carry";  // PTX text cannot contain this name.

// Returns the types in an opcode, in order.
std::vector<Type> types_of(const Words& words) {
  std::vector<Type> out;
  for (size_t i = 1; i < words.size(); ++i)
    if (const auto type = type_of(words[i])) out.push_back(*type);
  return out;
}

// Returns the operands, where a|b counts as two.
std::vector<const Operand*> flattened(const std::vector<Operand>& operands) {
  std::vector<const Operand*> out;
  for (const Operand& o : operands) {
    if (o.kind != Operand::Kind::Pair)
      out.push_back(&o);
    else
      for (const Operand& part : o.parts) out.push_back(&part);
  }
  return out;
}

int num_destinations(const isa::OpRow& row) {
  int n = 0;
  for (OperandKind kind : row.operands.view()) n += isa::is_destination(kind);
  return n;
}

const Operand& sink() {
  static const Operand kSink;
  return kSink;
}

Operand name_operand(const std::string& name, TextPosition position) {
  Operand o;
  o.kind = Operand::Kind::Name;
  o.name = name;
  o.position = position;
  return o;
}

Operand integer_operand(uint64_t value, TextPosition position) {
  Operand o;
  o.kind = Operand::Kind::Integer;
  o.value = value;
  o.position = position;
  return o;
}

}  // namespace

void KernelLowering::report_no_row(const Instruction& inst) {
  const std::string name = joined(inst.words);
  const std::string near = nearest_row(name);
  no_support(inst.position, near.empty() ? fmt::format("no op '{}'", name)
                                         : fmt::format("no op '{}'; did you mean '{}'?", name, near));
}

void KernelLowering::lower_row(const Instruction& inst, int row, std::vector<const Operand*> operands) {
  const isa::OpRow& r = isa::op_table()[size_t(row)];
  const std::vector<Type> types = types_of(inst.words);
  const Type result = types.empty() ? Type{} : types.front(), input = types.empty() ? Type{} : types.back();
  const size_t written = !inst.operands.empty() && inst.operands[0].kind == Operand::Kind::Pair
                             ? inst.operands[0].parts.size()
                             : 1;
  for (int n = int(written); n < num_destinations(r); ++n) operands.insert(operands.begin() + n, &sink());
  if (operands.size() != r.operands.count)
    return error(inst.position, fmt::format("'{}' takes {} operands, not {}", joined(inst.words),
                                            r.operands.count, operands.size()));
  std::vector<VirtualOperand> out;
  int64_t imm = 0;
  for (size_t i = 0; i < operands.size(); ++i) {
    const OperandKind kind = r.operands.kind[i];
    const Operand& o = *operands[i];
    if (isa::slots_of(kind) > 1) {
      if (o.kind != Operand::Kind::Vector || int(o.parts.size()) != isa::slots_of(kind))
        return error(o.position, fmt::format("expected a vector of {} operands", isa::slots_of(kind)));
      const bool writes = isa::is_destination(kind);
      for (const Operand& part : o.parts)
        out.push_back(writes ? destination(part, OperandKind::Dst32, result)
                             : source(part, OperandKind::Src32, input));
    } else if (kind == OperandKind::Address32 || kind == OperandKind::Address64) {
      out.push_back(address(o, kind == OperandKind::Address64, imm));
    } else {
      out.push_back(isa::is_destination(kind) ? destination(o, kind, result) : source(o, kind, input));
    }
  }
  note_free_arithmetic(inst, out);
  emit(row, std::move(out), imm);
  finish_moves();
}

void KernelLowering::note_free_arithmetic(const Instruction& inst,
                                          const std::vector<VirtualOperand>& operands) {
  const std::string& op = inst.words[0];
  const bool ftz = inst.words.size() == 3 && inst.words[1] == "ftz";
  const auto type = type_of(inst.words.back());
  if ((op != "mul" && op != "add" && op != "sub") || !type || type->kind != 'f' ||
      operands.front().kind != VirtualOperand::Kind::Register)
    return;
  const std::string suffix = (ftz ? ".ftz." : ".") + inst.words.back();
  const bool is_free = (inst.words.size() == 2 || ftz) && guard_ == kNoRegister;
  const auto [known, is_new] = free_.try_emplace(operands.front().reg, FreeResult{op[0], suffix});
  if (!is_free || (!is_new && (known->second.op != op[0] || known->second.suffix != suffix)))
    known->second.op = kNotFree;
}

void KernelLowering::lower_generic(const Instruction& inst) {
  const int row = find_row(inst.words);
  if (row < 0) return report_no_row(inst);
  lower_row(inst, row, flattened(inst.operands));
}

// Lowers a conversion between f16 and bf16 by way of f32, which has all values of both. So only the second
// step rounds.
bool KernelLowering::lower_half_conversion(const Instruction& inst) {
  const std::string name = joined(inst.words);
  const bool to_half = name == "cvt.rn.f16.bf16";
  if ((!to_half && name != "cvt.rn.bf16.f16") || inst.operands.size() != 2) return false;
  const VirtualOperand wide = compute32(to_half ? "cvt.f32.bf16" : "cvt.f32.f16",
                                        {source(inst.operands[1], OperandKind::Src32, {'f', 16})});
  emit(isa::op_index(to_half ? "cvt.rn.f16.f32" : "cvt.rn.bf16.f32"),
       {destination(inst.operands[0], OperandKind::Dst32, {'f', 16}), wide});
  finish_moves();
  return true;
}

bool KernelLowering::lower_special(const Instruction& inst) {
  using Handler = void (KernelLowering::*)(const Instruction&);
  static const std::map<std::string, Handler> kHandlers{{"mov", &KernelLowering::lower_move},
                                                        {"setp", &KernelLowering::lower_setp},
                                                        {"cvta", &KernelLowering::lower_address_conversion},
                                                        {"ld", &KernelLowering::lower_memory},
                                                        {"ldu", &KernelLowering::lower_memory},
                                                        {"st", &KernelLowering::lower_memory},
                                                        {"atom", &KernelLowering::lower_memory},
                                                        {"red", &KernelLowering::lower_memory},
                                                        {"bar", &KernelLowering::lower_barrier},
                                                        {"barrier", &KernelLowering::lower_barrier},
                                                        {"membar", &KernelLowering::lower_fence},
                                                        {"fence", &KernelLowering::lower_fence},
                                                        {"vote", &KernelLowering::lower_old_warp_op},
                                                        {"shfl", &KernelLowering::lower_old_warp_op}};
  // These instructions are hints without a result.
  static const std::set<std::string> kNothing{"prefetch", "prefetchu",      "applypriority",
                                              "pmevent",  "griddepcontrol", "setmaxnreg"};
  const std::string& op = inst.words[0];
  if (kNothing.contains(op)) return true;
  if (op == "cvt" && lower_half_conversion(inst)) return true;
  if (op == "nanosleep") return emit(isa::op_index("yield"), {}), true;
  const bool has_carry = has_word(inst.words, "cc") || op == "addc" || op == "subc" || op == "madc";
  if (has_carry) {
    lower_carry(inst);
    return true;
  }
  const auto handler = kHandlers.find(op);
  if (handler == kHandlers.end()) return false;
  (this->*handler->second)(inst);
  return true;
}

void KernelLowering::lower_move(const Instruction& inst) {
  if (inst.operands.size() == 2) {
    const bool joins = inst.operands[1].kind == Operand::Kind::Vector,
               splits = inst.operands[0].kind == Operand::Kind::Vector;
    if (joins != splits)
      return joins ? join_parts(inst, inst.operands[0], inst.operands[1].parts)
                   : split_parts(inst, inst.operands[0].parts, inst.operands[1]);
  }
  if (joined(inst.words) == "mov.pred" && inst.operands.size() == 2) {
    const VirtualOperand from = predicate_source(inst.operands[1]);
    emit(isa::op_index("mov.pred"), {destination(inst.operands[0], OperandKind::DstPred, {'p', 1}), from});
    return;
  }
  lower_generic(inst);
}

// These selectors of prmt.b32 put the low halves, or the low bytes, of two registers side by side.
constexpr uint64_t kLowHalves = 0x5410, kLowBytes = 0x0040;

void KernelLowering::join_parts(const Instruction& inst, const Operand& to,
                                const std::vector<Operand>& parts) {
  const std::vector<Type> types = types_of(inst.words);
  const uint32_t bits = types.empty() ? 0 : types[0].bits,
                 part = parts.empty() ? 0 : bits / uint32_t(parts.size());
  const auto value = [&](size_t i) { return source(parts[i], OperandKind::Src32, {'b', 32}); };
  const auto halves = [&](VirtualOperand low, VirtualOperand high) {
    return compute32("prmt.b32", {low, high, VirtualOperand::value(kLowHalves)});
  };
  if (bits == 64 && part == 32) {
    const VirtualOperand low = value(0), high = value(1);
    emit(isa::op_index("pack.b64"), {destination(to, OperandKind::Dst64, types[0]), low, high});
  } else if (bits == 64 && part == 16) {
    const VirtualOperand low = halves(value(0), value(1)), high = halves(value(2), value(3));
    emit(isa::op_index("pack.b64"), {destination(to, OperandKind::Dst64, types[0]), low, high});
  } else if (bits == 16 && part == 8) {
    emit(isa::op_index("prmt.b32"), {destination(to, OperandKind::Dst32, types[0]), value(0), value(1),
                                     VirtualOperand::value(kLowBytes)});
  } else if (bits == 32 && (part == 16 || part == 8)) {
    const auto bytes = [&](size_t i) {
      return compute32("prmt.b32", {value(i), value(i + 1), VirtualOperand::value(kLowBytes)});
    };
    const VirtualOperand low = part == 16 ? value(0) : bytes(0), high = part == 16 ? value(1) : bytes(2);
    emit(isa::op_index("prmt.b32"),
         {destination(to, OperandKind::Dst32, types[0]), low, high, VirtualOperand::value(kLowHalves)});
  } else {
    no_support(inst.position,
               fmt::format("not supported: '{}' of {} parts", joined(inst.words), parts.size()));
  }
  finish_moves();
}

void KernelLowering::split_parts(const Instruction& inst, const std::vector<Operand>& parts,
                                 const Operand& from) {
  const std::vector<Type> types = types_of(inst.words);
  const uint32_t bits = types.empty() ? 0 : types[0].bits,
                 part = parts.empty() ? 0 : bits / uint32_t(parts.size());
  const auto split = [&](VirtualOperand word, size_t first) {
    for (uint32_t i = 0; i < std::min(bits, 32u) / part; ++i) {
      const VirtualOperand to = destination(parts[first + i], OperandKind::Dst32, {'b', part});
      emit(isa::op_index("bfe.u32"),
           {to, word, VirtualOperand::value(i * part), VirtualOperand::value(part)});
    }
  };
  if (bits == 64 && (part == 32 || part == 16)) {
    const VirtualOperand pair = source(from, OperandKind::Src64, types[0]);
    const bool whole = part == 32;
    const VirtualOperand low = whole ? destination(parts[0], OperandKind::Dst32, {'b', 32})
                                     : VirtualOperand::of(temporary(RegisterClass::B32));
    const VirtualOperand high = whole ? destination(parts[1], OperandKind::Dst32, {'b', 32})
                                      : VirtualOperand::of(temporary(RegisterClass::B32));
    emit(isa::op_index("unpack.b64"), {low, high, pair});
    if (!whole) {
      split(low, 0);
      split(high, 2);
    }
  } else if ((bits == 32 && (part == 16 || part == 8)) || (bits == 16 && part == 8)) {
    // The value is copied first, because one of the parts may be written where the whole is read.
    split(compute32("mov.b32", {source(from, OperandKind::Src32, types[0])}), 0);
  } else {
    no_support(inst.position,
               fmt::format("not supported: '{}' into {} parts", joined(inst.words), parts.size()));
  }
  finish_moves();
}

// Lowers setp.CMP{.BOOL}.type p{|q}, a, b{, c}: p = (a CMP b) BOOL c, q = !(a CMP b) BOOL c.
void KernelLowering::lower_setp(const Instruction& inst) {
  const int row = find_row(inst.words);
  const bool pair = !inst.operands.empty() && inst.operands[0].kind == Operand::Kind::Pair;
  if (row >= 0 && (!pair || num_destinations(isa::op_table()[size_t(row)]) == 2))
    return lower_row(inst, row, flattened(inst.operands));
  Words plain;
  std::string combine;
  for (const std::string& word : inst.words) {
    if (word == "and" || word == "or" || word == "xor")
      combine = word + ".pred";
    else
      plain.push_back(word);
  }
  const int comparison = find_row(plain);
  if (comparison < 0) return report_no_row(inst);
  if (inst.operands.size() != (combine.empty() ? 3u : 4u))
    return error(inst.position, fmt::format("'{}' has the wrong number of operands", joined(inst.words)));
  const OperandKind kind = isa::op_table()[size_t(comparison)].operands.kind[1];
  const Type type = types_of(inst.words).back();
  const VirtualOperand a = source(inst.operands[1], kind, type), b = source(inst.operands[2], kind, type);
  const VirtualOperand third = combine.empty() ? VirtualOperand{} : predicate_source(inst.operands[3]);
  const VirtualOperand holds = compute_predicate(isa::op_table()[size_t(comparison)].name, {a, b});
  const std::vector<const Operand*> to = flattened({inst.operands[0]});
  for (size_t i = 0; i < to.size(); ++i) {
    const VirtualOperand test = i == 0 ? holds : compute_predicate("not.pred", {holds});
    const VirtualOperand p = destination(*to[i], OperandKind::DstPred, {'p', 1});
    if (combine.empty())
      emit(isa::op_index("mov.pred"), {p, test});
    else
      emit(isa::op_index(combine), {p, test, third});
  }
}

// The condition code of PTX becomes a predicate operand of the row: after the result, and after the sources.
void KernelLowering::lower_carry(const Instruction& inst) {
  const int row = find_row(inst.words);
  if (row < 0) return report_no_row(inst);
  if (!placed_.contains(kCarry)) {
    Symbol symbol;
    symbol.type = {'p', 1};
    symbol.reg = temporary(RegisterClass::Predicate);
    placed_[kCarry] = symbol;
  }
  const Operand carry = name_operand(kCarry, inst.position);
  const isa::OpRow& r = isa::op_table()[size_t(row)];
  if (inst.operands.empty())
    return error(inst.position, fmt::format("'{}' takes operands", joined(inst.words)));
  Instruction whole = inst;
  if (num_destinations(r) == 2) {
    whole.operands[0].kind = Operand::Kind::Pair;
    whole.operands[0].parts = {inst.operands[0], carry};
  }
  if (r.operands.kind[r.operands.count - 1u] == OperandKind::SrcPred) whole.operands.push_back(carry);
  lower_row(whole, row, flattened(whole.operands));
}

void KernelLowering::lower_address_conversion(const Instruction& inst) {
  Words words = inst.words;
  for (std::string& word : words) word = word.substr(0, word.find("::"));
  if (has_word(words, "global") && has_word(words, "u64")) {
    Instruction move = inst;  // A generic address of global memory equals the global address.
    move.words = {"mov", "b64"};
    return lower_generic(move);
  }
  Instruction plain = inst;
  plain.words = words;
  lower_generic(plain);
}

void KernelLowering::lower_barrier(const Instruction& inst) {
  Instruction plain = inst;
  plain.words = {"bar"};
  for (size_t i = 1; i < inst.words.size(); ++i)
    if (inst.words[i] != "cta" && inst.words[i] != "aligned") plain.words.push_back(inst.words[i]);
  const int row = isa::find_op(joined(plain.words));
  if (row < 0) return report_no_row(inst);
  std::vector<const Operand*> operands = flattened(inst.operands);
  // The number of threads may be left out, and then means the whole block.
  const Operand all = integer_operand(0, inst.position);
  const size_t count = isa::op_table()[size_t(row)].operands.count;
  const bool is_warp = has_word(plain.words, "warp");
  const size_t threads = has_word(plain.words, "red") ? 2 : 1;
  if (!is_warp && operands.empty()) operands.push_back(&all);
  if (!is_warp && operands.size() + 1 == count)
    operands.insert(operands.begin() + std::ptrdiff_t(threads), &all);
  lower_row(plain, row, operands);
}

void KernelLowering::lower_fence(const Instruction& inst) {
  const char* scope = has_word(inst.words, "sys")   ? "membar.sys"
                      : has_word(inst.words, "cta") ? "membar.cta"
                                                    : "membar.gl";
  emit(isa::op_index(scope), {});
}

// Lowers vote and shfl without .sync, which mean all lanes of the warp.
void KernelLowering::lower_old_warp_op(const Instruction& inst) {
  if (has_word(inst.words, "sync")) return lower_generic(inst);
  Instruction modern = inst;
  modern.words.insert(modern.words.begin() + 1, "sync");
  modern.operands.push_back(integer_operand(~uint64_t{0}, inst.position));
  lower_generic(modern);
}

}  // namespace glint::frontend::ptx
