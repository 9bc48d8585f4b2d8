// Rewrites lengths of arrays, sizes of blocks and ends of any-hit shaders word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/module_repairs.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <set>
#include <span>
#include <spirv/unified1/spirv.hpp11>
#include <string_view>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

template <class Visit>
void for_each(const std::vector<uint32_t>& words, const Visit& visit) {
  for (size_t at = kHeaderWords; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16)
    visit(spv::Op(words[at] & 0xffff), std::span(words).subspan(at, words[at] >> 16));
}

}  // namespace

bool has_specialised_lengths(const std::vector<uint32_t>& spirv) {
  std::set<uint32_t> specialised;
  bool found = false;
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    if (op == OpSpecConstant || op == OpSpecConstantOp) specialised.insert(w[2]);
    if (op == OpTypeArray) found |= specialised.contains(w[3]);
  });
  return found;
}

bool has_calls(const std::vector<uint32_t>& spirv) {
  bool found = false;
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t>) { found |= op == OpFunctionCall; });
  return found;
}

std::vector<uint32_t> with_local_size(std::vector<uint32_t> spirv) {
  uint32_t size = 0;                                    // id of the constant
  std::map<uint32_t, uint32_t> numbers;                 // scalar constants by id
  std::map<uint32_t, std::array<uint32_t, 3>> vectors;  // ids of the parts
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    if (op == OpDecorate && w.size() == 4 && spv::Decoration(w[2]) == spv::Decoration::BuiltIn &&
        spv::BuiltIn(w[3]) == spv::BuiltIn::WorkgroupSize)
      size = w[1];
    if ((op == OpConstant || op == OpSpecConstant) && w.size() == 4) numbers[w[2]] = w[3];
    if ((op == OpConstantComposite || op == OpSpecConstantComposite) && w.size() == 6)
      vectors[w[2]] = {w[3], w[4], w[5]};
  });
  const auto parts = vectors.find(size);
  if (size == 0 || parts == vectors.end()) return spirv;
  for (size_t at = kHeaderWords; at < spirv.size() && spirv[at] >> 16 != 0; at += spirv[at] >> 16) {
    if (op_of(spirv[at]) != OpExecutionMode || spirv[at] >> 16 != 6) continue;
    if (spv::ExecutionMode(spirv[at + 2]) != spv::ExecutionMode::LocalSize) continue;
    for (size_t axis = 0; axis < 3; ++axis)
      if (const auto number = numbers.find(parts->second[axis]); number != numbers.end())
        spirv[at + 3 + axis] = number->second;
  }
  return spirv;
}

std::vector<uint32_t> with_positive_lengths(std::vector<uint32_t> spirv, std::vector<std::string>* names) {
  std::map<uint32_t, uint32_t> zeros;  // type of each constant 0
  std::map<uint32_t, uint32_t> ones;   // constant 1 that replaces a constant 0
  std::map<uint32_t, std::string> name;
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    if (op == OpName && w.size() > 2) name[w[1]] = reinterpret_cast<const char*>(&w[2]);
    if ((op == OpConstant && w.size() == 4 && w[3] == 0) || op == OpConstantNull) zeros[w[2]] = w[1];
    if (op == OpTypeArray && zeros.contains(w[3])) ones[w[3]] = 0;
  });
  if (ones.empty()) return spirv;
  std::vector<uint32_t> out(spirv.begin(), spirv.begin() + kHeaderWords);
  for (auto& [zero, one] : ones) one = out[kBoundWord]++;
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    const size_t begin = out.size();
    out.insert(out.end(), w.begin(), w.end());
    const bool declares = op == OpConstant || op == OpConstantNull;
    if (const auto one = declares ? ones.find(w[2]) : ones.end(); one != ones.end())
      append(out, OpConstant, {w[1], one->second, 1});
    if (op != OpTypeArray) return;
    const auto one = ones.find(w[3]);
    if (one == ones.end()) return;
    out[begin + 3] = one->second;
    if (name.contains(w[3]) && std::find(names->begin(), names->end(), name[w[3]]) == names->end())
      names->push_back(name[w[3]]);
  });
  return out;
}

std::vector<uint32_t> with_ends_that_return(const std::vector<uint32_t>& spirv) {
  std::set<uint32_t> entries;
  uint32_t no_value = 0;
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    if (op == OpEntryPoint) entries.insert(w[2]);
    if (op == OpTypeVoid) no_value = w[1];
  });
  std::vector<uint32_t> out(spirv.begin(), spirv.begin() + kHeaderWords);
  bool is_entry = false, has_declarations = false;
  uint32_t result = 0;
  for_each(spirv, [&](spv::Op op, std::span<const uint32_t> w) {
    if (op != OpCapability && !has_declarations) {
      append(out, OpCapability, {uint32_t(spv::Capability::RayTracingNV)});
      const std::vector<uint32_t> name = words_of("SPV_NV_ray_tracing");
      out.push_back(uint32_t(name.size() + 1) << 16 | uint32_t(OpExtension));
      out.insert(out.end(), name.begin(), name.end());
      has_declarations = true;
    }
    if (op == OpFunction) is_entry = entries.contains(w[2]), result = w[1];
    const bool ends = op == OpIgnoreIntersectionKHR || op == OpTerminateRayKHR;
    if (is_entry || !ends) {
      out.insert(out.end(), w.begin(), w.end());
      return;
    }
    append(out, op == OpIgnoreIntersectionKHR ? OpIgnoreIntersectionNV : OpTerminateRayNV, {});
    if (result == no_value) return append(out, OpReturn, {});
    const uint32_t undefined = out[kBoundWord]++;
    append(out, OpUndef, {result, undefined});
    append(out, OpReturnValue, {undefined});
  });
  return out;
}

}  // namespace glint::frontend
