// Lowers asynchronous copies to shared memory and barriers there.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <iterator>
#include <string>
#include <string_view>

#include "frontend/ptx/lowering.h"
#include "isa/mbarrier.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

namespace {

bool is_shared(const std::string& word) {
  return word == "shared" || word == "shared::cta";
}

// Says which operands and words an mbarrier.* has.
struct BarrierForm {
  std::string_view op;
  size_t least, most;      // operands
  std::string_view words;  // besides the space and the type
};
constexpr BarrierForm kForms[] = {
    {"init", 2, 2, ""},
    {"inval", 1, 1, ""},
    {"arrive", 2, 3, " noComplete release relaxed cta cluster "},
    {"arrive_drop", 2, 3, " noComplete release relaxed cta cluster "},
    {"test_wait", 3, 3, " parity acquire relaxed cta cluster "},
    {"try_wait", 3, 4, " parity acquire relaxed cta cluster "},
    {"pending_count", 2, 2, ""},
};

// Returns the form of an opcode whose words all have a meaning, or null.
const BarrierForm* form_of(const Words& words) {
  if (words.size() < 3 || words.back() != "b64") return nullptr;
  const auto form = std::find_if(std::begin(kForms), std::end(kForms),
                                 [&](const BarrierForm& f) { return f.op == words[1]; });
  if (form == std::end(kForms)) return nullptr;
  const bool all_known = std::all_of(words.begin() + 2, words.end() - 1, [&](const std::string& word) {
    return (is_shared(word) && form->op != "pending_count") ||
           form->words.find(" " + word + " ") != std::string_view::npos;
  });
  const bool has_order =
      has_word(words, "release") || has_word(words, "acquire") || has_word(words, "relaxed");
  const bool has_scope = has_word(words, "cta") || has_word(words, "cluster");
  return all_known && (has_scope || !has_order) ? &*form : nullptr;
}

}  // namespace

bool KernelLowering::lower_async(const Instruction& inst) {
  const Words& words = inst.words;
  if (words[0] == "mbarrier") return lower_mbarrier(inst), true;
  if (words[0] != "cp" || words.size() < 3) return false;
  if (words[2] == "mbarrier")
    lower_copy_arrival(inst);
  else if (words[2] == "ca" || words[2] == "cg")
    lower_copy(inst);
  else
    lower_copy_group(inst);
  return true;
}

// Lowers cp.async. Model: .cg copies go through the L1 as .ca copies do, and an L2 cache policy changes
// nothing.
void KernelLowering::lower_copy(const Instruction& inst) {
  const bool is_known = std::all_of(inst.words.begin() + 3, inst.words.end(), [](const std::string& word) {
    return is_shared(word) || word == "global" || word.starts_with("L2::");
  });
  if (!is_known || !has_word(inst.words, "global") || inst.words.size() < 5) return report_no_row(inst);
  const std::string name = joined(inst.words);
  const auto& operands = inst.operands;
  const size_t policies = has_word(inst.words, "L2::cache_hint") ? 1 : 0;
  if (operands.size() < 3 + policies || operands.size() > 4 + policies)
    return error(inst.position,
                 fmt::format("'{}' takes two addresses, a number of bytes{}", name,
                             policies ? " and a cache policy" : ", and what of them to leave out"));
  const Operand& size = operands[2];
  const bool has_size = size.kind == Operand::Kind::Integer &&
                        (size.value == 16 || (inst.words[2] == "ca" && (size.value == 4 || size.value == 8)));
  if (!has_size)
    return error(size.position,
                 fmt::format("'{}' copies {} bytes", name, inst.words[2] == "ca" ? "4, 8 or 16" : "16"));
  const VirtualOperand bytes = operands.size() == 4 + policies
                                   ? source_bytes(inst, operands[3], uint32_t(size.value))
                                   : VirtualOperand::value(size.value);
  const VirtualOperand to = whole_address(operands[0]);
  int64_t imm = 0;
  const VirtualOperand from = address(operands[1], true, imm);
  emit(isa::op_index(fmt::format("cp.async.b{}", 8 * size.value)), {to, from, bytes}, imm);
}

// Returns how many bytes a copy takes from its source: a number, or none under a predicate.
VirtualOperand KernelLowering::source_bytes(const Instruction& inst, const Operand& o, uint32_t bytes) {
  const Symbol* symbol = o.kind == Operand::Kind::Name ? find(o.name) : nullptr;
  if (symbol && symbol->kind == Symbol::Kind::Register && symbol->type.kind == 'p')
    return compute32("selp.b32",
                     {VirtualOperand::value(0), VirtualOperand::value(bytes), predicate_source(o)});
  const bool is_wide = symbol && symbol->kind == Symbol::Kind::Register && symbol->type.bits != 32;
  if (is_wide || (o.kind == Operand::Kind::Integer && o.value > bytes))
    error(o.position,
          fmt::format("'{}' takes a predicate or 0 to {} bytes in 32 bits here", joined(inst.words), bytes));
  return source(o, OperandKind::Src32, {'u', 32});
}

// Returns an address of shared memory with its displacement.
VirtualOperand KernelLowering::whole_address(const Operand& o) {
  int64_t imm = 0;
  const VirtualOperand base = address(o, false, imm);
  if (imm == 0) return base;
  if (base.kind == VirtualOperand::Kind::Constant)
    return VirtualOperand::value(base.constant + uint64_t(imm));
  return compute32("add.u32", {base, VirtualOperand::value(uint32_t(imm))});
}

// Lowers cp.async.commit_group, wait_group and wait_all, which is both of them.
void KernelLowering::lower_copy_group(const Instruction& inst) {
  const std::string& op = inst.words[2];
  const bool waits = op == "wait_group";
  if (inst.words.size() != 3 || (!waits && op != "commit_group" && op != "wait_all"))
    return report_no_row(inst);
  if (inst.operands.size() != (waits ? 1u : 0u))
    return error(inst.position, fmt::format("'{}' takes {}", joined(inst.words),
                                            waits ? "a number of groups" : "no operands"));
  if (waits && (inst.operands[0].kind != Operand::Kind::Integer || inst.operands[0].value > INT32_MAX))
    return error(inst.operands[0].position, "'cp.async.wait_group' takes a constant number of groups");
  if (!waits) emit(isa::op_index("cp.async.commit_group"), {});
  if (op != "commit_group")
    emit(isa::op_index("cp.async.wait_group"), {VirtualOperand::value(waits ? inst.operands[0].value : 0)});
}

void KernelLowering::lower_copy_arrival(const Instruction& inst) {
  Words plain;
  for (const std::string& word : inst.words) plain.push_back(is_shared(word) ? "shared" : word);
  const bool is_generic = !has_word(plain, "shared");
  if (is_generic && !plain.empty()) plain.insert(plain.end() - 1, "shared");
  const int row = isa::find_op(joined(plain));
  if (row < 0) return report_no_row(inst);
  if (inst.operands.size() != 1)
    return error(inst.position, fmt::format("'{}' takes an address", joined(inst.words)));
  int64_t imm = 0;
  const VirtualOperand at = barrier_address(inst.operands[0], is_generic, imm);
  emit(row, {at}, imm);
}

// Returns the address of a barrier in shared memory. One without a space is generic.
VirtualOperand KernelLowering::barrier_address(const Operand& o, bool is_generic, int64_t& imm) {
  if (!is_generic) return address(o, false, imm);
  return compute32("cvt.u32.u64", {compute64("cvta.to.shared.u64", {address(o, true, imm)})});
}

// Lowers mbarrier.*. Model: .release, .acquire and scopes change nothing, because accesses have their effects
// in order. Choice: .noComplete arrives as without it. PTX leaves open what it does when it ends a phase, and
// an H200 goes on.
void KernelLowering::lower_mbarrier(const Instruction& inst) {
  const BarrierForm* const form = form_of(inst.words);
  if (!form) return report_no_row(inst);
  const bool must_count = has_word(inst.words, "noComplete");
  if (inst.operands.size() < (must_count ? 3 : form->least) || inst.operands.size() > form->most)
    return error(inst.position, fmt::format("'{}' takes {} operands, not {}", joined(inst.words),
                                            must_count ? form->most : form->least, inst.operands.size()));
  if (form->op == "pending_count") return lower_pending_count(inst);
  const bool has_parity = has_word(inst.words, "parity"), asks = form->op.ends_with("_wait");
  const std::string name = fmt::format("mbarrier.{}{}.shared.b64", form->op, has_parity ? ".parity" : "");
  const isa::OpRow& row = isa::op_table()[isa::op_index(name)];
  const bool has_result = isa::is_destination(row.operands.kind[0]);
  const size_t first = has_result ? 1 : 0;
  int64_t imm = 0;
  std::vector<VirtualOperand> operands{barrier_address(
      inst.operands[first], std::none_of(inst.words.begin(), inst.words.end(), is_shared), imm)};
  if (inst.operands.size() > first + 1)
    operands.push_back(source(inst.operands[first + 1], row.operands.kind[first + 1],
                              {'b', asks && !has_parity ? 64u : 32u}));
  else if (form->op.starts_with("arrive"))
    operands.push_back(VirtualOperand::value(1));
  if (inst.operands.size() > 3) source(inst.operands[3], OperandKind::Src32, {'u', 32});
  if (has_result)
    operands.insert(operands.begin(), destination(inst.operands[0], row.operands.kind[0], {'b', 64}));
  emit(int(isa::op_index(name)), std::move(operands), imm);
  finish_moves();
}

// Picks the count out of what an arrival has returned.
void KernelLowering::lower_pending_count(const Instruction& inst) {
  const VirtualOperand state = source(inst.operands[1], OperandKind::Src64, {'b', 64});
  const VirtualOperand low = compute32(
      "cvt.u32.u64", {compute64("shr.u64", {state, VirtualOperand::value(isa::Mbarrier::kPendingShift)})});
  emit(isa::op_index("and.b32"), {destination(inst.operands[0], OperandKind::Dst32, {'u', 32}), low,
                                  VirtualOperand::value(isa::Mbarrier::kMost)});
  finish_moves();
}

}  // namespace glint::frontend::ptx
