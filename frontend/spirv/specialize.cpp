// Finds OpSpecConstant* by their SpecId and writes literals into them.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/specialize.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>
#include <spirv/unified1/spirv.hpp11>

#include "base/diagnostics.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

// Calls visit(op, words of the instruction) for each instruction. Returns false when a length is wrong.
template <class Words, class Visit>
bool for_each_instruction(Words& words, const Visit& visit) {
  for (size_t i = kHeaderWords; i < words.size();) {
    const size_t length = words[i] >> 16;
    if (length == 0 || i + length > words.size()) return false;
    visit(spv::Op(words[i] & 0xffff), std::span(words).subspan(i, length));
    i += length;
  }
  return true;
}

// Returns the first word of a literal. Numbers of less than 32 bits fill the word: signed integers are
// extended by their sign, and other numbers by zeros (SPIR-V specification, 2.2.1).
uint32_t literal_word(uint64_t bits, const std::string& number) {
  const uint32_t unused = number == "s8" || number == "u8"                        ? 24
                          : number == "s16" || number == "u16" || number == "f16" ? 16
                                                                                  : 0;
  const uint32_t at_top = uint32_t(bits) << unused;
  return number[0] == 's' ? uint32_t(int32_t(at_top) >> unused) : at_top >> unused;
}

struct Found {
  std::map<uint32_t, uint32_t> spec_id;  // by result id
  std::map<uint32_t, std::string> name, number;
  std::vector<SpecConstant> constants;
};

void visit_name(Found& found, spv::Op op, std::span<const uint32_t> w) {
  using enum spv::Op;
  if (op == OpName && w.size() > 2) found.name[w[1]] = text_at(w.subspan(2));
  if (op == OpDecorate && w.size() > 3 && spv::Decoration(w[2]) == spv::Decoration::SpecId)
    found.spec_id[w[1]] = w[3];
  if (op == OpTypeBool && w.size() > 1) found.number[w[1]] = "bool";
  if (op == OpTypeInt && w.size() > 3) found.number[w[1]] = fmt::format("{}{}", w[3] ? 's' : 'u', w[2]);
  if (op == OpTypeFloat && w.size() > 2) found.number[w[1]] = fmt::format("f{}", w[2]);
}

void visit_declaration(Found& found, spv::Op op, std::span<const uint32_t> w) {
  using enum spv::Op;
  visit_name(found, op, w);
  const bool is_bool = op == OpSpecConstantTrue || op == OpSpecConstantFalse;
  if ((!is_bool && op != OpSpecConstant) || w.size() < 3) return;
  const auto id = found.spec_id.find(w[2]);
  if (id == found.spec_id.end()) return;
  uint64_t value = op == OpSpecConstantTrue;
  if (!is_bool && w.size() > 3) value = w[3] | (w.size() > 4 ? uint64_t{w[4]} << 32 : 0);
  found.constants.push_back({id->second, found.name[w[2]], found.number[w[1]], value});
}

}  // namespace

std::vector<SpecConstant> spec_constants(const std::vector<uint32_t>& words, const std::string& name) {
  Found found;
  if (!for_each_instruction(
          words, [&](spv::Op op, std::span<const uint32_t> w) { visit_declaration(found, op, w); }))
    throw UserError({name, 0, 0}, "malformed SPIR-V: an instruction's length is wrong");
  std::sort(found.constants.begin(), found.constants.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  return found.constants;
}

std::vector<uint32_t> specialize(std::vector<uint32_t> words, const std::map<uint32_t, uint64_t>& values) {
  Found found;
  for_each_instruction(words, [&](spv::Op op, std::span<uint32_t> w) {
    using enum spv::Op;
    visit_name(found, op, w);
    const bool is_bool = op == OpSpecConstantTrue || op == OpSpecConstantFalse;
    if ((!is_bool && op != OpSpecConstant) || w.size() < 3) return;
    const auto id = found.spec_id.find(w[2]);
    const auto value = id == found.spec_id.end() ? values.end() : values.find(id->second);
    if (value == values.end()) return;
    if (is_bool)
      w[0] = (w[0] & 0xffff'0000u) | uint32_t(value->second ? OpSpecConstantTrue : OpSpecConstantFalse);
    if (!is_bool && w.size() > 3) w[3] = literal_word(value->second, found.number[w[1]]);
    if (!is_bool && w.size() > 4) w[4] = uint32_t(value->second >> 32);
  });
  return words;
}

}  // namespace glint::frontend
