// Rewrites the capabilities, the built-in variable and the instruction of position fetches, word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/known_positions.h"

#include <array>
#include <cstring>
#include <initializer_list>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

class Rewrite {
 public:
  explicit Rewrite(const std::vector<uint32_t>& words)
      : words_(words), out_(words.begin(), words.begin() + kHeaderWords) {}

  bool is_needed() const {
    bool found = false;
    for_each_instruction(words_, [&](spv::Op op, std::span<const uint32_t> w) {
      found |= op == OpCapability && w.size() == 2 && is_ours(w[1]);
    });
    return found;
  }

  std::vector<uint32_t> run() {
    for_each_instruction(words_, [&](spv::Op op, std::span<const uint32_t> w) { change(op, w); });
    return std::move(out_);
  }

 private:
  static bool is_ours(uint32_t capability) {
    return spv::Capability(capability) == kRayTracingPositionFetch ||
           spv::Capability(capability) == kRayQueryPositionFetch;
  }
  uint32_t fresh() { return out_[kBoundWord]++; }
  void put(spv::Op op, std::initializer_list<uint32_t> operands) {
    out_.push_back(uint32_t(operands.size() + 1) << 16 | uint32_t(op));
    out_.insert(out_.end(), operands);
  }

  void note(spv::Op op, std::span<const uint32_t> w) {
    if (op == OpTypeMatrix && w.size() == 4 && w[3] == 4) matrix_of_[w[2]] = w[1];
    if (op == OpTypeArray && w.size() == 4) element_of_[w[1]] = w[2];
    if (op == OpConstant && w.size() == 4) constants_[w[2]] = {w[1], w[3]};
  }

  // Declares the types and constants of the instructions that follow, before the first function.
  void declare() {
    for_each_instruction(words_, [&](spv::Op op, std::span<const uint32_t> w) {
      if (op != kGetIntersectionTriangleVertexPositions || w.size() != 5) return;
      const auto column = element_of_.find(w[1]);
      const auto which = constants_.find(w[4]);
      if (column == element_of_.end() || which == constants_.end()) return;
      if (!matrix_of_.contains(column->second)) {
        const uint32_t id = matrix_of_[column->second] = fresh();
        put(OpTypeMatrix, {id, column->second, 4});
      }
      if (shifted_.contains(w[4])) return;
      const uint32_t id = shifted_[w[4]] = fresh();
      put(OpConstant, {which->second[0], id, which->second[1] + kPositionsOfIntersection});
    });
  }

  void change(spv::Op op, std::span<const uint32_t> w) {
    note(op, w);
    if (op == OpFunction && !has_declared_) has_declared_ = true, declare();
    if (op == OpCapability && w.size() == 2 && is_ours(w[1])) return;
    if (op == OpExtension && is_extension(w)) return;
    if (op == kGetIntersectionTriangleVertexPositions && w.size() == 5 && shifted_.contains(w[4]))
      return fetch(w);
    out_.insert(out_.end(), w.begin(), w.end());
    const bool is_positions = op == OpDecorate && w.size() == 4 &&
                              spv::Decoration(w[2]) == spv::Decoration::BuiltIn &&
                              spv::BuiltIn(w[3]) == kHitTriangleVertexPositions;
    if (is_positions) out_[out_.size() - 2] = uint32_t(spv::Decoration::Location);
  }

  static bool is_extension(std::span<const uint32_t> w) {
    const std::string_view text(reinterpret_cast<const char*>(w.data() + 1), (w.size() - 1) * 4);
    return text.substr(0, text.find('\0')) == "SPV_KHR_ray_tracing_position_fetch";
  }

  void fetch(std::span<const uint32_t> w) {
    const uint32_t column = element_of_.at(w[1]), matrix = fresh();
    put(OpRayQueryGetIntersectionObjectToWorldKHR, {matrix_of_.at(column), matrix, w[3], shifted_.at(w[4])});
    std::array<uint32_t, 3> corner{};
    for (uint32_t i = 0; i < 3; ++i) {
      corner[i] = fresh();
      put(OpCompositeExtract, {column, corner[i], matrix, i});
    }
    put(OpCompositeConstruct, {w[1], w[2], corner[0], corner[1], corner[2]});
  }

  const std::vector<uint32_t>& words_;
  std::vector<uint32_t> out_;
  std::map<uint32_t, uint32_t> matrix_of_;                 // by column type
  std::map<uint32_t, uint32_t> element_of_;                // by array type
  std::map<uint32_t, uint32_t> shifted_;                   // by constant
  std::map<uint32_t, std::array<uint32_t, 2>> constants_;  // type and value
  bool has_declared_ = false;
};

}  // namespace

std::vector<uint32_t> with_known_positions(std::vector<uint32_t> spirv) {
  if (spirv.size() < kHeaderWords) return spirv;
  Rewrite rewrite(spirv);
  return rewrite.is_needed() ? rewrite.run() : spirv;
}

}  // namespace glint::frontend
