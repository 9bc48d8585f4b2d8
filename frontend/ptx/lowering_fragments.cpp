// Lowers wmma: loads, stores and products of fragments, as Hopper's assembler makes instructions of them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "frontend/ptx/fragment.h"
#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

// Holds a load or a store of a fragment. An element lies in a line, which is a row or a column of the matrix
// in memory, and at a place of the line. Lane 4g + t accesses line g and place t * step, or the other way
// round.
struct FragmentAccess {
  Fragment fragment;
  bool is_load = true, is_contiguous = true;
  std::string space;
  bool is_wide = true;                    // addresses have 64 bits
  VirtualOperand base, line_bytes;        // of the matrix, and from one line to the next
  int64_t imm = 0;                        // displacement of the base
  std::vector<VirtualOperand> registers;  // of the lane
  uint32_t bytes(uint32_t elements) const { return elements * fragment.bits / 8; }
};

namespace {

struct FragmentForm {
  char matrix = 0;
  bool row_major = true;
  std::string shape, space, type;
  bool is_known = false;
};
// Reads wmma.load.M.sync.aligned.LAYOUT.SHAPE[.SPACE].TYPE, and wmma.store.d in the same way.
FragmentForm fragment_form(const Words& words) {
  FragmentForm form;
  if (words.size() < 8 || words[3] != "sync" || words[4] != "aligned" || words[2].size() != 1) return form;
  form.matrix = words[2] == "d" ? 'c' : words[2][0];
  form.row_major = words[5] == "row";
  form.shape = words[6];
  form.type = words.back();
  for (size_t i = 7; i + 1 < words.size(); ++i) form.space = words[i].substr(0, words[i].find("::"));
  form.is_known = (words[5] == "row" || words[5] == "col") && words.size() <= 9 &&
                  (form.space.empty() || form.space == "global" || form.space == "shared");
  return form;
}

constexpr const char* kFragments =
    "wmma has m16n16k16, m32n8k16 and m8n32k16 of f16, bf16, s8 and u8, m16n16k8 of tf32, m8n8k4 of f64, "
    "and, by rows and columns, m8n8k32 of s4 and u4 and m8n8k128 of b1";

int access_row(const FragmentAccess& access, uint32_t bits, uint32_t parts) {
  MemoryForm form;
  form.op = std::string(access.is_load ? "ld" : "st");
  form.space = access.space;
  form.type = {bits < 32 ? 'u' : 'b', bits};
  form.type_name = form.type.kind + std::to_string(bits);
  return find_access_row(form, parts);
}

}  // namespace

void KernelLowering::lower_fragments(const Instruction& inst) {
  const std::string kind = inst.words.size() > 1 ? inst.words[1] : "";
  if (kind == "mma")
    lower_fragment_product(inst);
  else
    lower_fragment_access(inst);
}

void KernelLowering::lower_fragment_access(const Instruction& inst) {
  const FragmentForm form = fragment_form(inst.words);
  const auto fragment = form.is_known ? fragment_of(form.matrix, form.shape, form.type) : std::nullopt;
  const bool fits = fragment && inst.words[1] == (inst.words[2] == "d" ? "store" : "load") &&
                    (fragment->bits >= 8 || fragment->is_contiguous(form.row_major));
  if (!fits)
    return no_support(inst.position, fmt::format("not supported: '{}'", joined(inst.words)), kFragments);
  FragmentAccess access;
  access.fragment = *fragment;
  access.is_load = inst.words[1] == "load";
  access.is_contiguous = fragment->is_contiguous(form.row_major);
  access.space = form.space;
  access.is_wide = form.space != "shared";
  const size_t of_registers = access.is_load ? 0 : 1, of_address = 1 - of_registers;
  std::vector<size_t> wanted(inst.operands.size() == 3 ? 3 : 2);
  wanted[of_registers] = fragment->registers;
  if (!has_registers(inst, wanted)) return;
  access.base = address(inst.operands[of_address], access.is_wide, access.imm);
  // Without a stride, lines lie one behind the other.
  const uint32_t rows = form.matrix == 'b' ? fragment->k : fragment->m,
                 columns = form.matrix == 'a' ? fragment->k : fragment->n;
  const VirtualOperand stride = inst.operands.size() == 3
                                    ? source(inst.operands[2], OperandKind::Src32, {'u', 32})
                                    : VirtualOperand::value(form.row_major ? columns : rows);
  if (stride.kind == VirtualOperand::Kind::Constant)
    access.line_bytes = VirtualOperand::value(access.bytes(uint32_t(stride.constant)));
  else if (fragment->bits < 8)
    access.line_bytes = compute32("shr.u32", {stride, VirtualOperand::value(fragment->bits == 4 ? 1 : 3)});
  else
    access.line_bytes = compute32("mul.lo.u32", {stride, VirtualOperand::value(fragment->bits / 8)});
  const OperandKind kind = access.is_load ? fragment->is_wide() ? OperandKind::Dst64 : OperandKind::Dst32
                           : fragment->is_wide() ? OperandKind::Src64
                                                 : OperandKind::Src32;
  access.registers =
      access.is_load ? registers_to(inst.operands[0], kind) : registers_from(inst.operands[1], kind);
  const bool is_half = fragment->bits == 16;
  if (is_half && access.is_load && !fragment->is_sum() && form.space == "shared")
    load_by_rows(access);
  else if (is_half && !access.is_contiguous)
    access_transposed(access);
  else if (access.is_contiguous)
    access_whole_words(access);
  else
    access_elements(access);
  // The registers that repeat others are copied, and the copies that nobody reads are dropped later.
  if (access.is_load)
    for (size_t r = fragment->distinct; r < access.registers.size(); ++r)
      late_.push_back(
          {isa::op_index("mov.b32"), access.registers[r], access.registers[r % fragment->distinct]});
  finish_moves();
}

// Returns base + index * line_bytes + more, where `more` is a number of bytes of the lane.
VirtualOperand KernelLowering::line_address(const FragmentAccess& access, VirtualOperand index,
                                            VirtualOperand more) {
  if (!access.is_wide) {
    const VirtualOperand line = compute32("mad.lo.s32", {index, access.line_bytes, access.base});
    return more.kind == VirtualOperand::Kind::None ? line : compute32("add.u32", {line, more});
  }
  const VirtualOperand line = compute64("mad.wide.s32", {index, access.line_bytes, access.base});
  return more.kind == VirtualOperand::Kind::None ? line : compute64("add.u64", {line, widened(more, false)});
}

// Lowers wmma.mma to products of 16x8 or 8x8 sums. Of m8n32k16 the transposed product is computed, because
// mma has the longer side in its first factor.
void KernelLowering::lower_fragment_product(const Instruction& inst) {
  const auto product = fragment_product(inst.words);
  const int row = product ? isa::find_op(product->op) : -1;
  if (row < 0)
    return no_support(inst.position, fmt::format("not supported: '{}'", joined(inst.words)), kFragments);
  const Fragment &a = product->a, &b = product->b, &c = product->c, &d = product->d;
  if (!has_registers(inst, {d.registers, a.registers, b.registers, c.registers})) return;
  const OperandKind from = a.is_wide() ? OperandKind::Src64 : OperandKind::Src32;
  std::vector<VirtualOperand> first = registers_from(inst.operands[1], from),
                              second = registers_from(inst.operands[2], from),
                              sums = registers_from(inst.operands[3], from), results;
  first.resize(a.distinct);
  second.resize(b.distinct);
  if (a.is_swapped()) std::swap(first, second);
  if (c.type == "f16" && d.type == "f32") sums = singles_of(sums);
  const size_t steps = product->steps, depths = product->depths;
  const auto part = [](const std::vector<VirtualOperand>& of, size_t at, size_t parts) {
    const size_t count = of.size() / parts;
    return std::vector<VirtualOperand>(of.begin() + long(at * count), of.begin() + long((at + 1) * count));
  };
  // Each step takes a part of the sums. A factor with one block of rows or columns serves both steps.
  const bool first_has_blocks = a.m != b.n && steps > 1;
  for (size_t s = 0; s < steps; ++s) {
    std::vector<VirtualOperand> sum = part(sums, s, steps);
    const auto of_a = first_has_blocks ? part(first, s, steps) : first,
               of_b = first_has_blocks ? second : part(second, s, steps);
    for (size_t k = 0; k < depths; ++k) {
      std::vector<VirtualOperand> next;
      for (size_t i = 0; i < sum.size(); ++i)
        next.push_back(VirtualOperand::of(temporary(a.is_wide() ? RegisterClass::B64 : RegisterClass::B32)));
      multiply(row, next, part(of_a, k, depths), part(of_b, k, depths), sum);
      sum = next;
    }
    results.insert(results.end(), sum.begin(), sum.end());
  }
  if (c.type == "f32" && d.type == "f16") results = halves_of(results);
  // The results are written last, because they may share registers with sources of a later step.
  const std::vector<VirtualOperand> to =
      registers_to(inst.operands[0], a.is_wide() ? OperandKind::Dst64 : OperandKind::Dst32);
  for (size_t i = 0; i < to.size(); ++i)
    late_.push_back({isa::op_index(a.is_wide() ? "mov.b64" : "mov.b32"), to[i], results[i]});
  finish_moves();
}

// Returns single-precision numbers of pairs of halves, and the other way round.
std::vector<VirtualOperand> KernelLowering::singles_of(const std::vector<VirtualOperand>& pairs) {
  std::vector<VirtualOperand> out;
  for (const VirtualOperand& pair : pairs) {
    out.push_back(compute32("cvt.f32.f16", {pair}));
    out.push_back(compute32("cvt.f32.f16", {compute32("shr.u32", {pair, VirtualOperand::value(16)})}));
  }
  return out;
}
std::vector<VirtualOperand> KernelLowering::halves_of(const std::vector<VirtualOperand>& singles) {
  std::vector<VirtualOperand> out;
  for (size_t i = 0; i + 1 < singles.size(); i += 2)
    out.push_back(compute32("cvt.rn.f16x2.f32", {singles[i + 1], singles[i]}));
  return out;
}

// Calls visit(address, displacement, register, element) for each element of the lane. One address serves all
// elements of a line; `across` exchanges what g and t mean.
template <class Visit>
void KernelLowering::for_each_place(const FragmentAccess& access, bool across, uint32_t elements,
                                    Visit&& visit) {
  const Fragment& fragment = access.fragment;
  const VirtualOperand lane = VirtualOperand::of(isa::Special::LaneId);
  const VirtualOperand g = compute32("shr.u32", {lane, VirtualOperand::value(2)}),
                       t = compute32("and.b32", {lane, VirtualOperand::value(3)});
  const auto times = [&](VirtualOperand x, uint32_t factor) {
    return factor == 1 ? x : compute32("mul.lo.u32", {x, VirtualOperand::value(factor)});
  };
  const bool lines_by_g = access.is_contiguous != across;
  FragmentAccess lane_access = access;
  const VirtualOperand own_line = lines_by_g ? g : times(t, fragment.step);
  const VirtualOperand own_place =
      lines_by_g ? times(t, access.bytes(fragment.step)) : times(g, access.bytes(1));
  lane_access.base = line_address(access, own_line, own_place);
  std::map<uint32_t, VirtualOperand> addresses{{0, lane_access.base}};
  for (uint32_t r = 0; r < fragment.distinct; ++r)
    for (uint32_t i = 0; i < elements; ++i) {
      const Fragment::Origin at = fragment.origin(r);
      const uint32_t line = access.is_contiguous ? at.outer : at.inner + i,
                     place = access.is_contiguous ? at.inner + i : at.outer;
      if (!addresses.contains(line))
        addresses[line] = line_address(lane_access, VirtualOperand::value(line), {});
      visit(addresses.at(line), access.imm + access.bytes(place), r, i);
    }
}

// Neighbours of a register are neighbours in memory, and of sums in single precision also two registers.
void KernelLowering::access_whole_words(const FragmentAccess& access) {
  const Fragment& fragment = access.fragment;
  const bool has_pairs = fragment.is_sum() && fragment.bits == 32;
  const uint32_t parts = has_pairs ? 2 : 1;
  const int row = access_row(access, fragment.is_wide() ? 64 : 32, parts);
  for_each_place(access, false, 1, [&](VirtualOperand at, int64_t imm, uint32_t r, uint32_t) {
    if (r % parts != 0) return;
    std::vector<VirtualOperand> operands(access.registers.begin() + r, access.registers.begin() + r + parts);
    operands.insert(access.is_load ? operands.end() : operands.begin(), at);
    emit(row, std::move(operands), imm);
  });
}

// Moves 8x8 half words as words of the matrix that lies in memory, and exchanges rows and columns in
// registers.
void KernelLowering::access_transposed(const FragmentAccess& access) {
  const int row = access_row(access, 32, 1);
  const int turn = isa::op_index("movmatrix.sync.aligned.m8n8.trans.b16");
  for_each_place(access, true, 1, [&](VirtualOperand at, int64_t imm, uint32_t r, uint32_t) {
    const VirtualOperand word = VirtualOperand::of(temporary(RegisterClass::B32));
    if (access.is_load) {
      emit(row, {word, at}, imm);
      emit(turn, {access.registers[r], word});
    } else {
      emit(turn, {word, access.registers[r]});
      emit(row, {at, word}, imm);
    }
  });
}

// Moves elements one by one; bytes are put together to words.
void KernelLowering::access_elements(const FragmentAccess& access) {
  const Fragment& fragment = access.fragment;
  const int row = access_row(access, fragment.bits, 1), insert = isa::op_index("bfi.b32");
  VirtualOperand word;
  for_each_place(access, false, fragment.per, [&](VirtualOperand at, int64_t imm, uint32_t r, uint32_t i) {
    if (!access.is_load) return void(emit(row, {at, access.registers[r]}, imm));
    if (fragment.per == 1) return void(emit(row, {access.registers[r], at}, imm));
    const VirtualOperand byte = VirtualOperand::of(temporary(RegisterClass::B32));
    emit(row, {byte, at}, imm);
    const bool is_last = i + 1 == fragment.per;
    const VirtualOperand next =
        is_last ? access.registers[r] : VirtualOperand::of(temporary(RegisterClass::B32));
    if (i > 0)
      emit(insert, {next, byte, word, VirtualOperand::value(i * fragment.bits),
                    VirtualOperand::value(fragment.bits)});
    word = i > 0 ? next : byte;
  });
}

// Loads half words of shared memory with ldmatrix, up to four blocks of 8x8 at a time. Lanes 8m to 8m + 7
// name the rows of block m.
void KernelLowering::load_by_rows(const FragmentAccess& access) {
  const Fragment& fragment = access.fragment;
  const uint32_t count = std::min(fragment.distinct, 4u);
  const VirtualOperand lane = VirtualOperand::of(isa::Special::LaneId);
  // The blocks lie in lines 0 and 8 and at places 0 and 8. Of two neighbours, the second lies in line 8 or at
  // place 8.
  const bool second_in_line =
      fragment.is_outer_first() && fragment.distinct > 2 ? access.is_contiguous : !access.is_contiguous;
  VirtualOperand line, place;
  if (second_in_line) {
    line = compute32("and.b32", {lane, VirtualOperand::value(15)});
    place = compute32("and.b32", {lane, VirtualOperand::value(16)});
  } else {
    const VirtualOperand high = compute32(
        "and.b32", {compute32("shr.u32", {lane, VirtualOperand::value(1)}), VirtualOperand::value(8)});
    line = compute32("or.b32", {compute32("and.b32", {lane, VirtualOperand::value(7)}), high});
    place = compute32("shl.b32",
                      {compute32("and.b32", {lane, VirtualOperand::value(8)}), VirtualOperand::value(1)});
  }
  FragmentAccess lane_access = access;
  lane_access.base = line_address(access, line, place);
  const int row = isa::op_index(fmt::format("ldmatrix.sync.aligned.m8n8.x{}{}.shared.b16", count,
                                            access.is_contiguous ? "" : ".trans"));
  for (uint32_t first = 0; first < fragment.distinct; first += count) {
    const Fragment::Origin at = fragment.origin(first);
    const uint32_t further = access.is_contiguous ? at.outer : at.inner;
    const VirtualOperand base =
        further == 0 ? lane_access.base : line_address(lane_access, VirtualOperand::value(further), {});
    std::vector<VirtualOperand> operands(access.registers.begin() + first,
                                         access.registers.begin() + first + count);
    operands.push_back(base);
    emit(row, std::move(operands), access.imm + access.bytes(access.is_contiguous ? at.inner : at.outer));
  }
}

}  // namespace glint::frontend::ptx
