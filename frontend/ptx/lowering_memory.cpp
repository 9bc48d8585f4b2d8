// Lowers loads, stores and atomics, and parameters of functions, which are registers.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fmt/format.h>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

void KernelLowering::lower_memory(const Instruction& inst) {
  const auto form = memory_form(inst.words);
  if (!form) return report_no_row(inst);
  const int fence = isa::op_index("membar.gl");
  if (form->releases) emit(fence, {});
  form->op == "ld" || form->op == "st" ? lower_access(inst, *form) : lower_atomic(inst, *form);
  if (form->acquires) emit(fence, {});
  if (form->op == "ld" && form->is_strong) emit(isa::op_index("yield"), {});
}

void KernelLowering::lower_atomic(const Instruction& inst, const MemoryForm& form) {
  const int row = find_atomic_row(form);
  if (row < 0 || form.vector != 1) return report_no_row(inst);
  std::vector<const Operand*> operands;
  for (const Operand& o : inst.operands) operands.push_back(&o);
  const isa::OpRow& r = isa::op_table()[size_t(row)];
  static const Operand kSink;
  if (form.op == "red" && isa::is_destination(r.operands.kind[0])) operands.insert(operands.begin(), &kSink);
  lower_row(inst, row, operands);
}

void KernelLowering::lower_access(const Instruction& inst, const MemoryForm& form) {
  const bool load = form.op == "ld";
  if (inst.operands.size() < 2)
    return error(inst.position, fmt::format("'{}' takes a value and an address", joined(inst.words)));
  const Operand &value = inst.operands[load ? 0 : 1], &at = inst.operands[load ? 1 : 0];
  const std::vector<const Operand*> parts = parts_of(value);
  if (parts.size() != form.vector)
    return error(value.position, fmt::format("'{}' moves {} values, but the operand has {}",
                                             joined(inst.words), form.vector, parts.size()));
  if (at.kind == Operand::Kind::Address && at.parts.size() == 1 && at.parts[0].kind == Operand::Kind::Name)
    if (const Symbol* symbol = find(at.parts[0].name); symbol && symbol->kind == Symbol::Kind::Parameter)
      return access_words(inst, form, *symbol, at.offset, parts);
  access_parts(inst, form, parts, at);
}

void KernelLowering::access_parts(const Instruction& inst, MemoryForm form,
                                  const std::vector<const Operand*>& parts, const Operand& at) {
  const int row = find_access_row(form, uint32_t(parts.size()));
  if (row < 0) {
    if (parts.size() == 1) return report_no_row(inst);
    // A vector without a row of its own is moved in parts.
    const size_t half = parts.size() / 2;
    Operand behind = at;
    behind.offset += int64_t(half * form.type.bits / 8);
    access_parts(inst, form, {parts.begin(), parts.begin() + std::ptrdiff_t(half)}, at);
    return access_parts(inst, form, {parts.begin() + std::ptrdiff_t(half), parts.end()}, behind);
  }
  const isa::OpRow& r = isa::op_table()[size_t(row)];
  if (form.type.bits == 64 && parts.size() > 1) return access_pairs(inst, form, row, parts, at);
  const bool load = form.op == "ld";
  if (options_.shape && load && parts.size() > 1 && form.type.bits < 32 &&
      (form.type.kind == 'u' || form.type.kind == 's'))
    return load_short_parts(form, parts, at);
  const OperandKind address_kind = r.operands.kind[load ? 1 : 0];
  const OperandKind value_kind = r.operands.kind[load ? 0 : 1];
  const bool vector = isa::slots_of(value_kind) > 1;
  int64_t imm = 0;
  const VirtualOperand base = address(at, address_kind == OperandKind::Address64, imm);
  std::vector<VirtualOperand> operands;
  for (const Operand* part : parts)
    operands.push_back(load ? destination(*part, vector ? OperandKind::Dst32 : value_kind, form.type)
                            : source(*part, vector ? OperandKind::Src32 : value_kind, form.type));
  operands.insert(load ? operands.end() : operands.begin(), base);
  emit(row, std::move(operands), imm);
  finish_moves();
}

// Loads short numbers as words, and picks each of them out with one instruction, as the hardware's assembler
// does.
void KernelLowering::load_short_parts(const MemoryForm& form, const std::vector<const Operand*>& parts,
                                      const Operand& at) {
  const uint32_t bytes = form.type.bits / 8;
  MemoryForm whole = form;
  const auto all = uint32_t(parts.size()) * bytes;
  whole.type = {'b', std::min(32u, 8 * all)};
  whole.type_name = fmt::format("b{}", whole.type.bits);
  const int row = find_access_row(whole, all / 4 > 1 ? all / 4 : 1);
  int64_t imm = 0;
  const isa::OpRow& r = isa::op_table()[size_t(row)];
  const VirtualOperand base = address(at, r.operands.kind[1] == OperandKind::Address64, imm);
  std::vector<VirtualOperand> words;
  for (uint32_t i = 0; i < std::max(all / 4, 1u); ++i)
    words.push_back(VirtualOperand::of(temporary(RegisterClass::B32)));
  std::vector<VirtualOperand> operands = words;
  operands.push_back(base);
  emit(row, std::move(operands), imm);
  for (uint32_t i = 0; i < parts.size(); ++i) {
    // A nibble picks a byte of the word, of a second word of zeros (4), or copies of a byte's sign (8 more).
    const uint32_t first = i * bytes % 4, last = first + bytes - 1;
    const uint32_t fill = form.type.kind == 's' ? 8 | last : 4;
    const uint32_t pick = first | (bytes == 2 ? last : fill) << 4 | fill << 8 | fill << 12;
    emit(isa::op_index("prmt.b32"),
         {destination(*parts[i], OperandKind::Dst32, form.type), words[i * bytes / 4],
          VirtualOperand::value(0), VirtualOperand::value(pick)});
  }
  finish_moves();
}

// Rows of pairs take each 64-bit value as two registers, low half first.
void KernelLowering::access_pairs(const Instruction&, const MemoryForm& form, int row,
                                  const std::vector<const Operand*>& parts, const Operand& at) {
  const bool load = form.op == "ld";
  const isa::OpRow& r = isa::op_table()[size_t(row)];
  int64_t imm = 0;
  const VirtualOperand base = address(at, r.operands.kind[load ? 1 : 0] == OperandKind::Address64, imm);
  std::vector<VirtualOperand> words;
  for (size_t i = 0; i < 2 * parts.size(); ++i)
    words.push_back(VirtualOperand::of(temporary(RegisterClass::B32)));
  if (!load)
    for (size_t i = 0; i < parts.size(); ++i)
      compute("unpack.b64",
              {words[2 * i], words[2 * i + 1], source(*parts[i], OperandKind::Src64, form.type)});
  std::vector<VirtualOperand> operands = words;
  operands.insert(load ? operands.end() : operands.begin(), base);
  emit(row, std::move(operands), imm);
  if (load)
    for (size_t i = 0; i < parts.size(); ++i)
      emit(isa::op_index("pack.b64"),
           {destination(*parts[i], OperandKind::Dst64, form.type), words[2 * i], words[2 * i + 1]});
  finish_moves();
}

void KernelLowering::access_words(const Instruction& inst, const MemoryForm& form, const Symbol& words,
                                  int64_t offset, const std::vector<const Operand*>& parts) {
  const uint32_t bytes = form.type.bits / 8;
  for (size_t i = 0; i < parts.size(); ++i) {
    const int64_t at = offset + int64_t(i * bytes);
    if (at < 0 || at % bytes != 0 || size_t(at) + bytes > words.elements.size() * 4 || bytes > 8)
      return error(inst.position, fmt::format("{} bytes at offset {} are outside the parameter", bytes, at));
    if (form.op == "ld")
      load_word_part(form, words, uint32_t(at), *parts[i]);
    else
      store_word_part(form, words, uint32_t(at), *parts[i]);
  }
}

void KernelLowering::load_word_part(const MemoryForm& form, const Symbol& words, uint32_t at,
                                    const Operand& to) {
  const VirtualOperand word = VirtualOperand::of(words.elements[at / 4]);
  const uint32_t bits = form.type.bits;
  if (bits == 64) {
    emit(isa::op_index("pack.b64"), {destination(to, OperandKind::Dst64, form.type), word,
                                     VirtualOperand::of(words.elements[at / 4 + 1])});
  } else if (bits == 32) {
    emit(isa::op_index("mov.b32"), {destination(to, OperandKind::Dst32, form.type), word});
  } else {
    const char* op = form.type.kind == 's' ? "bfe.s32" : "bfe.u32";
    emit(isa::op_index(op), {destination(to, OperandKind::Dst32, form.type), word,
                             VirtualOperand::value(at % 4 * 8), VirtualOperand::value(bits)});
  }
  finish_moves();
}

void KernelLowering::store_word_part(const MemoryForm& form, const Symbol& words, uint32_t at,
                                     const Operand& from) {
  const VirtualOperand word = VirtualOperand::of(words.elements[at / 4]);
  const uint32_t bits = form.type.bits;
  if (bits == 64) {
    const VirtualOperand value = source(from, OperandKind::Src64, form.type);
    emit(isa::op_index("unpack.b64"), {word, VirtualOperand::of(words.elements[at / 4 + 1]), value});
    return;
  }
  const VirtualOperand value = source(from, OperandKind::Src32, form.type);
  if (bits == 32)
    emit(isa::op_index("mov.b32"), {word, value});
  else
    emit(isa::op_index("bfi.b32"),
         {word, value, word, VirtualOperand::value(at % 4 * 8), VirtualOperand::value(bits)});
}

}  // namespace glint::frontend::ptx
