// Lowers video instructions on one number, which take bytes and halves of registers and may add a third
// number.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/ptx/lowering.h"
#include "frontend/ptx/unsupported.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

// Says what the words of a video instruction ask for (PTX ISA, "Scalar Video Instructions").
struct VideoForm {
  std::string op;
  Type to{'u', 32}, a, b;
  bool wraps = false, adds = false, adds_one = false;
  std::string compare;   // of vset
  bool is_known = true;  // Every word has a meaning, and the types are there.
  bool has_unsupported_word = false;
};

namespace {

void read_word(const std::string& word, VideoForm& form) {
  static constexpr std::array<std::string_view, 6> kCompare{"eq", "ne", "lt", "le", "gt", "ge"};
  const bool is_shift = form.op == "vshl" || form.op == "vshr", is_product = form.op == "vmad";
  if (form.op == "vset" && std::find(kCompare.begin(), kCompare.end(), word) != kCompare.end())
    form.compare = word;
  else if (is_shift && (word == "clamp" || word == "wrap"))
    form.wraps = word == "wrap";
  else if (is_product && word == "po")
    form.adds_one = true;
  else if (!is_product && word == "add")
    form.adds = true;
  else if (word == "sat" || (is_product ? word == "shr7" || word == "shr15" : word == "min" || word == "max"))
    form.has_unsupported_word = true;
  else
    form.is_known = false;
}

VideoForm video_form(const Words& words) {
  VideoForm form;
  form.op = words[0];
  std::vector<Type> types;
  for (size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "u32" || words[i] == "s32")
      types.push_back({words[i][0], 32});
    else
      read_word(words[i], form);
  }
  const bool is_set = form.op == "vset";
  form.is_known = form.is_known && types.size() == (is_set ? 2 : 3) && is_set == !form.compare.empty();
  if (!form.is_known) return form;
  if (!is_set) form.to = types[0];
  form.a = types[types.size() - 2];
  form.b = form.op == "vshl" || form.op == "vshr" ? Type{'u', 32} : types.back();
  return form;
}

// Describes the byte or the half of a register that .b0 to .b3, .h0 and .h1 name.
struct RegisterPart {
  uint32_t first = 0, bits = 32;
};
RegisterPart register_part(const Operand& o) {
  if (!is_part_selector(o.element)) return {};
  const uint32_t bits = o.element[0] == 'b' ? 8 : 16;
  return {uint32_t(o.element[1] - '0') * bits, bits};
}
Operand whole_of(const Operand& o) {
  Operand whole = o;
  if (is_part_selector(o.element)) whole.element.clear();
  return whole;
}

}  // namespace

// Returns whether the instruction is one of these, and lowers it. One without parts and a second operation is
// left to its row, where it has one. Choice: what an H200 does otherwise than the PTX ISA says is refused, so
// that no kernel gives results that a card does not give: .sat with parts or a second operation, .min, .max,
// .shr7 and .shr15, and results in .h1.
bool KernelLowering::lower_video(const Instruction& inst) {
  static constexpr std::array<std::string_view, 9> kOps{"vadd", "vsub", "vabsdiff", "vmin", "vmax",
                                                        "vshl", "vshr", "vset",     "vmad"};
  if (std::find(kOps.begin(), kOps.end(), inst.words[0]) == kOps.end()) return false;
  const bool has_part = std::any_of(inst.operands.begin(), inst.operands.end(),
                                    [](const Operand& o) { return register_part(o).bits < 32; });
  if (!has_part && find_row(inst.words) >= 0) return false;
  const VideoForm form = video_form(inst.words);
  const std::string name = joined(inst.words);
  if (!form.is_known) return report_no_row(inst), true;
  const bool merges = !inst.operands.empty() && register_part(inst.operands[0]).bits < 32;
  if (form.has_unsupported_word || (merges && inst.operands[0].element == "h1")) {
    no_support(inst.position,
               fmt::format("not supported: '{}' with parts of registers, a second operation or a "
                           "scale, where an H200 does not do what the PTX ISA says",
                           name));
    return true;
  }
  const size_t wanted = merges || form.adds || form.op == "vmad" ? 4 : 3;
  if (inst.operands.size() != wanted || (merges && (form.adds || form.op == "vmad"))) {
    error(inst.position,
          fmt::format("'{}' takes {} operands here, and adds or writes a part, not both", name, wanted));
    return true;
  }
  const VirtualOperand third =
      wanted == 4 ? source(inst.operands[3], OperandKind::Src32, form.to) : VirtualOperand::value(0);
  finish_video(inst, video_result(inst, form, third), third, form.adds);
  return true;
}

// Returns the result of the first operation.
VirtualOperand KernelLowering::video_result(const Instruction& inst, const VideoForm& form,
                                            VirtualOperand third) {
  const auto number = [&](const Operand& o, const Type& type) {
    const RegisterPart part = register_part(o);
    const VirtualOperand value = source(whole_of(o), OperandKind::Src32, type);
    if (part.bits == 32) return value;
    return compute32(type.kind == 's' ? "bfe.s32" : "bfe.u32",
                     {value, VirtualOperand::value(part.first), VirtualOperand::value(part.bits)});
  };
  const VirtualOperand a = number(inst.operands[1], form.a);
  VirtualOperand b = number(inst.operands[2], form.b);
  if (form.op == "vset") {
    const bool is_same = form.a.kind == form.b.kind;
    const VirtualOperand holds =
        is_same ? compute_predicate(fmt::format("setp.{}.{}32", form.compare, form.a.kind), {a, b})
                : compute_predicate(fmt::format("setp.{}.s64", form.compare),
                                    {widened(a, form.a.kind == 's'), widened(b, form.b.kind == 's')});
    return compute32("selp.b32", {VirtualOperand::value(1), VirtualOperand::value(0), holds});
  }
  if (form.op == "vmad") {
    const VirtualOperand sum = compute32("mad.lo.u32", {a, b, third});
    return form.adds_one ? compute32("add.u32", {sum, VirtualOperand::value(1)}) : sum;
  }
  if (form.op != "vshl" && form.op != "vshr")
    return compute32(fmt::format("{}.{}32.{}32.{}32", form.op, form.to.kind, form.a.kind, form.b.kind),
                     {a, b});
  // Shifts by more than 31 clamp by themselves.
  if (form.wraps) b = compute32("and.b32", {b, VirtualOperand::value(31)});
  return compute32(form.op == "vshl" ? "shl.b32" : form.a.kind == 's' ? "shr.s32" : "shr.u32", {a, b});
}

// Writes the result, the sum of it and the third number, or the third number with the result as a part of it.
void KernelLowering::finish_video(const Instruction& inst, VirtualOperand result, VirtualOperand third,
                                  bool adds) {
  const RegisterPart part = register_part(inst.operands[0]);
  const VirtualOperand to = destination(whole_of(inst.operands[0]), OperandKind::Dst32, {'b', 32});
  if (part.bits < 32)
    emit(isa::op_index("bfi.b32"),
         {to, result, third, VirtualOperand::value(part.first), VirtualOperand::value(part.bits)});
  else if (adds)
    emit(isa::op_index("add.u32"), {to, result, third});
  else
    emit(isa::op_index("mov.b32"), {to, result});
  finish_moves();
}

}  // namespace glint::frontend::ptx
