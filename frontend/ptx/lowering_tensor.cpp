// Lowers products of matrices (mma) and what moves matrices (ldmatrix, stmatrix, movmatrix).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

namespace {

bool is_fp8(const std::string& word) {
  return word == "e4m3" || word == "e5m2";
}

// Holds the words of a product: mma.sync.aligned.SHAPE.row.col[.satfinite].D.A.B.C[.and|.xor.popc].
struct ProductForm {
  std::string shape, d, a, b, c;
};
// Returns the form of an opcode of that kind, or one with an empty shape.
ProductForm product_form(const Words& words) {
  ProductForm form;
  if (words.size() < 10 || words[1] != "sync" || words[2] != "aligned") return form;
  const size_t types = words[6] == "satfinite" ? 7 : 6;
  if (words.size() < types + 4) return form;
  form = {words[3], words[types], words[types + 1], words[types + 2], words[types + 3]};
  return form;
}

// Lists the shapes of products with the same types, or all types when there are none.
std::string what_there_is(const Words& words) {
  const ProductForm form = product_form(words);
  std::set<std::string> shapes, types;
  for (const isa::OpRow& row : isa::op_table()) {
    if (!row.name.starts_with("mma.")) continue;
    Words known;
    for (std::string_view rest = row.name; !rest.empty();) {
      const size_t dot = std::min(rest.find('.'), rest.size());
      known.emplace_back(rest.substr(0, dot));
      rest.remove_prefix(std::min(dot + 1, rest.size()));
    }
    const ProductForm other = product_form(known);
    const std::string of_row = fmt::format("{}.{}.{}.{}", other.d, other.a, other.b, other.c);
    types.insert(of_row);
    if (of_row == fmt::format("{}.{}.{}.{}", form.d, form.a, form.b, form.c)) shapes.insert(other.shape);
  }
  if (!shapes.empty())
    return fmt::format("with these types there are the shapes {}, with .row.col", fmt::join(shapes, ", "));
  return fmt::format("there are the types {}, .e4m3 and .e5m2", fmt::join(types, ", "));
}

}  // namespace

bool KernelLowering::lower_tensor(const Instruction& inst) {
  const std::string& op = inst.words[0];
  if (op == "mma")
    lower_product(inst);
  else if (op == "wmma")
    lower_fragments(inst);
  else if (op == "ldmatrix" || op == "stmatrix")
    lower_matrix_access(inst);
  else
    return false;
  return true;
}

std::vector<VirtualOperand> KernelLowering::registers_to(const Operand& o, OperandKind kind) {
  std::vector<VirtualOperand> out;
  for (const Operand* part : parts_of(o)) out.push_back(destination(*part, kind, {'b', 32}));
  return out;
}
std::vector<VirtualOperand> KernelLowering::registers_from(const Operand& o, OperandKind kind) {
  std::vector<VirtualOperand> out;
  for (const Operand* part : parts_of(o)) out.push_back(source(*part, kind, {'b', 32}));
  return out;
}

// Returns whether the operands have as many registers as the instruction takes, and reports it if not.
bool KernelLowering::has_registers(const Instruction& inst, std::vector<size_t> wanted) {
  if (inst.operands.size() != wanted.size()) {
    error(inst.position, fmt::format("'{}' takes {} operands, not {}", joined(inst.words), wanted.size(),
                                     inst.operands.size()));
    return false;
  }
  for (size_t i = 0; i < wanted.size(); ++i) {
    const size_t has = parts_of(inst.operands[i]).size();
    if (wanted[i] == 0 || has == wanted[i]) continue;
    error(inst.operands[i].position, fmt::format("operand {} of '{}' has {} registers, not {}", i + 1,
                                                 joined(inst.words), wanted[i], has));
    return false;
  }
  return true;
}

void KernelLowering::multiply(int row, const std::vector<VirtualOperand>& d,
                              const std::vector<VirtualOperand>& a, const std::vector<VirtualOperand>& b,
                              const std::vector<VirtualOperand>& c) {
  std::vector<VirtualOperand> operands = d;
  for (const auto* part : {&a, &b, &c}) operands.insert(operands.end(), part->begin(), part->end());
  emit(row, std::move(operands));
}

void KernelLowering::lower_product(const Instruction& inst) {
  const ProductForm form = product_form(inst.words);
  if (is_fp8(form.a) && is_fp8(form.b)) return lower_fp8_product(inst);
  if (form.a == "f64" && form.shape.starts_with("m16n8k")) return lower_double_product(inst);
  const int row = isa::find_op(joined(inst.words));
  if (row < 0)
    return no_support(inst.position, fmt::format("not supported: '{}'", joined(inst.words)),
                      what_there_is(inst.words));
  const bool is_wide = form.a == "f64";
  const OperandKind to = is_wide ? OperandKind::Dst64 : OperandKind::Dst32,
                    from = is_wide ? OperandKind::Src64 : OperandKind::Src32;
  const auto& kinds = isa::op_table()[size_t(row)].operands.kind;
  const auto registers = [&](size_t i) { return size_t(isa::slots_of(kinds[i])); };
  if (!has_registers(inst, is_wide
                               ? std::vector<size_t>{2, 1, 1, 2}
                               : std::vector<size_t>{registers(0), registers(1), registers(2), registers(3)}))
    return;
  multiply(row, registers_to(inst.operands[0], to), registers_from(inst.operands[1], from),
           registers_from(inst.operands[2], from), registers_from(inst.operands[3], from));
  finish_moves();
}

// Lowers products of fp8. Hopper has no instruction for them: its assembler makes halves of the numbers,
// multiplies the even and then the odd pairs of neighbours, begins with zeros, and adds the summands at the
// end (nvcc 13.0 for sm_90). Model: on other parts results may differ in their last bits.
void KernelLowering::lower_fp8_product(const Instruction& inst) {
  const ProductForm form = product_form(inst.words);
  const bool is_half = form.d == "f16";
  const size_t depth = form.shape == "m16n8k32"   ? 2
                       : form.shape == "m16n8k16" ? 1
                                                  : 0,
               sums = is_half ? 2 : 4;
  const bool is_known = inst.words.size() == 10 && inst.words[4] == "row" && inst.words[5] == "col" &&
                        form.d == form.c && (is_half || form.d == "f32") && depth > 0;
  if (!is_known)
    return no_support(inst.position, fmt::format("not supported: '{}'", joined(inst.words)),
                      "of fp8 there are m16n8k16 and m16n8k32, with sums in .f32 or .f16");
  if (!has_registers(inst, {sums, 2 * depth, depth, sums})) return;
  const std::string type = is_half ? "f16" : "f32";
  const int row =
      isa::find_op(fmt::format("mma.sync.aligned.m16n8k{}.row.col.{}.f16.f16.{}", 8 * depth, type, type));
  const auto halves = [&](const Operand& o, const std::string& format, bool odd) {
    std::vector<VirtualOperand> out;
    for (VirtualOperand word : registers_from(o, OperandKind::Src32)) {
      if (odd) word = compute32("shr.u32", {word, VirtualOperand::value(16)});
      out.push_back(compute32(fmt::format("cvt.rn.f16x2.{}x2", format), {word}));
    }
    return out;
  };
  std::vector<VirtualOperand> sum(sums, VirtualOperand::value(0));
  for (const bool odd : {false, true}) {
    std::vector<VirtualOperand> next;
    for (size_t i = 0; i < sums; ++i) next.push_back(VirtualOperand::of(temporary(RegisterClass::B32)));
    multiply(row, next, halves(inst.operands[1], form.a, odd), halves(inst.operands[2], form.b, odd), sum);
    sum = next;
  }
  const std::vector<VirtualOperand> c = registers_from(inst.operands[3], OperandKind::Src32),
                                    d = registers_to(inst.operands[0], OperandKind::Dst32);
  for (size_t i = 0; i < sums; ++i)
    late_.push_back(
        {isa::op_index("mov.b32"), d[i], compute32(is_half ? "add.rn.f16x2" : "add.rn.f32", {c[i], sum[i]})});
  finish_moves();
}

// Lowers a product of doubles with 16 rows to products of 8 rows and a depth of 4. Sums are added in the same
// order, so the bits are the same. Model: Hopper has instructions of 16 rows, which take half the time.
void KernelLowering::lower_double_product(const Instruction& inst) {
  const ProductForm form = product_form(inst.words);
  const size_t blocks = form.shape == "m16n8k4"    ? 1
                        : form.shape == "m16n8k8"  ? 2
                        : form.shape == "m16n8k16" ? 4
                                                   : 0;
  Words small = inst.words;
  small[3] = "m8n8k4";
  const int row = isa::find_op(joined(small));
  if (row < 0 || blocks == 0)
    return no_support(inst.position, fmt::format("not supported: '{}'", joined(inst.words)),
                      "of doubles there are m8n8k4, m16n8k4, m16n8k8 and m16n8k16, with .row.col");
  if (!has_registers(inst, {4, 2 * blocks, blocks, 4})) return;
  const std::vector<VirtualOperand> a = registers_from(inst.operands[1], OperandKind::Src64),
                                    b = registers_from(inst.operands[2], OperandKind::Src64),
                                    c = registers_from(inst.operands[3], OperandKind::Src64),
                                    d = registers_to(inst.operands[0], OperandKind::Dst64);
  for (size_t half = 0; half < 2; ++half) {
    std::vector<VirtualOperand> sum{c[2 * half], c[2 * half + 1]};
    for (size_t k = 0; k < blocks; ++k) {
      std::vector<VirtualOperand> next{VirtualOperand::of(temporary(RegisterClass::B64)),
                                       VirtualOperand::of(temporary(RegisterClass::B64))};
      multiply(row, next, {a[2 * k + half]}, {b[k]}, sum);
      sum = next;
    }
    late_.push_back({isa::op_index("mov.b64"), d[2 * half], sum[0]});
    late_.push_back({isa::op_index("mov.b64"), d[2 * half + 1], sum[1]});
  }
  finish_moves();
}

// Lowers ldmatrix and stmatrix. An address without a space is a generic one in shared memory. Assemblers take
// the words in any order, and programs have the number of matrices before and behind their shape.
void KernelLowering::lower_matrix_access(const Instruction& inst) {
  static constexpr std::array<std::string_view, 9> kOrder{"sync", "aligned", "m8n8",   "x1", "x2",
                                                          "x4",   "trans",   "shared", "b16"};
  const auto rank = [](const std::string& word) { return std::find(kOrder.begin(), kOrder.end(), word); };
  Words words = inst.words;
  for (std::string& word : words) word = word.substr(0, word.find("::cta"));
  const bool is_shared = has_word(words, "shared");
  if (!is_shared) words.emplace_back("shared");
  std::stable_sort(words.begin() + 1, words.end(),
                   [&](const std::string& x, const std::string& y) { return rank(x) < rank(y); });
  const int row = isa::find_op(joined(words));
  if (row < 0)
    return no_support(inst.position, fmt::format("not supported: '{}'", joined(inst.words)),
                      "there are .m8n8 with .x1, .x2 and .x4, .b16, and .trans");
  const bool is_load = words[0] == "ldmatrix";
  const size_t registers = size_t(isa::slots_of(isa::op_table()[size_t(row)].operands.kind[is_load ? 0 : 1]));
  if (!has_registers(inst, is_load ? std::vector<size_t>{registers, 0} : std::vector<size_t>{0, registers}))
    return;
  const Operand &at = inst.operands[is_load ? 1 : 0], &matrices = inst.operands[is_load ? 0 : 1];
  int64_t imm = 0;
  VirtualOperand base = address(at, !is_shared, imm);
  if (!is_shared) base = compute32("cvt.u32.u64", {compute64("cvta.to.shared.u64", {base})});
  std::vector<VirtualOperand> operands =
      is_load ? registers_to(matrices, OperandKind::Dst32) : registers_from(matrices, OperandKind::Src32);
  operands.insert(is_load ? operands.end() : operands.begin(), base);
  emit(row, std::move(operands), imm);
  finish_moves();
}

}  // namespace glint::frontend::ptx
