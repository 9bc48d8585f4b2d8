// Adds capabilities and copies of structures, word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/glslang_repairs.h"

#include <map>
#include <set>
#include <span>
#include <spirv/unified1/spirv.hpp11>
#include <utility>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

class Repairs {
 public:
  explicit Repairs(const Words& words) : words_(words) {}

  Words run() {
    for_each_instruction(words_, [&](spv::Op op, std::span<const uint32_t> w) { note(op, w); });
    out_.assign(words_.begin(), words_.begin() + kHeaderWords);
    for (const spv::Capability missing : missing_) append(out_, OpCapability, {uint32_t(missing)});
    for_each_instruction(words_, [&](spv::Op op, std::span<const uint32_t> w) {
      if (op == OpStore && w.size() >= 3) return store(w);
      out_.insert(out_.end(), w.begin(), w.end());
    });
    return std::move(out_);
  }

 private:
  void note(spv::Op op, std::span<const uint32_t> w) {
    if (op == OpCapability && w.size() == 2) had_.insert(spv::Capability(w[1]));
    if (op == OpTypeInt && w.size() == 4 && w[2] == 8) need(spv::Capability::Int8);
    if (op == OpTypeInt && w.size() == 4 && w[2] == 16) need(spv::Capability::Int16);
    if (op == OpTypeFloat && w.size() >= 3 && w[2] == 16) need(spv::Capability::Float16);
    if (op == OpTypeStruct && w.size() >= 2) structs_.insert(w[1]);
    if (op == OpTypePointer && w.size() == 4) pointee_[w[1]] = w[3];
    bool has_result = false, has_type = false;
    spv::HasResultAndType(op, &has_result, &has_type);
    if (has_result && has_type && w.size() >= 3) type_[w[2]] = w[1];
  }
  void need(spv::Capability capability) {
    if (!had_.contains(capability)) missing_.insert(capability);
  }

  void store(std::span<const uint32_t> w) {
    const auto pointer = type_.find(w[1]), object = type_.find(w[2]);
    const auto place = pointer == type_.end() ? pointee_.end() : pointee_.find(pointer->second);
    const bool differs = place != pointee_.end() && object != type_.end() &&
                         place->second != object->second && structs_.contains(place->second) &&
                         structs_.contains(object->second);
    uint32_t stored = w[2];
    if (differs) append(out_, OpCopyLogical, {place->second, stored = out_[kBoundWord]++, w[2]});
    const size_t at = out_.size();
    out_.insert(out_.end(), w.begin(), w.end());
    out_[at + 2] = stored;
  }

  const Words& words_;
  Words out_;
  std::set<spv::Capability> had_, missing_;
  std::set<uint32_t> structs_;
  std::map<uint32_t, uint32_t> pointee_;  // by id of a pointer type
  std::map<uint32_t, uint32_t> type_;     // by id of a value
};

}  // namespace

std::vector<uint32_t> with_glslang_repairs(const std::vector<uint32_t>& spirv) {
  return Repairs(spirv).run();
}

}  // namespace glint::frontend
