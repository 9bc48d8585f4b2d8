// Answers questions about a parsed module: types, constants, names, entry points, successors of blocks.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>

#include "base/check.h"
#include "base/diagnostics.h"
#include "frontend/spirv/module.h"

namespace glint::frontend {

std::optional<isa::Stage> stage_of(spv::ExecutionModel model) {
  switch (model) {
    case spv::ExecutionModel::RayGenerationKHR:
      return isa::Stage::RayGeneration;
    case spv::ExecutionModel::IntersectionKHR:
      return isa::Stage::Intersection;
    case spv::ExecutionModel::AnyHitKHR:
      return isa::Stage::AnyHit;
    case spv::ExecutionModel::ClosestHitKHR:
      return isa::Stage::ClosestHit;
    case spv::ExecutionModel::MissKHR:
      return isa::Stage::Miss;
    case spv::ExecutionModel::CallableKHR:
      return isa::Stage::Callable;
    case spv::ExecutionModel::GLCompute:
      return isa::Stage::Compute;
    default:
      return std::nullopt;
  }
}

const Type& Module::type(Id id) const {
  const auto it = types.find(id);
  GLINT_CHECK(it != types.end(), "no type %{}", id);
  return it->second;
}

std::optional<uint32_t> Module::constant_u32(Id id) const {
  const auto it = constants.find(id);
  if (it == constants.end()) return std::nullopt;
  if (it->second.op == spv::Op::OpConstantNull) return 0;
  if ((it->second.op != spv::Op::OpConstant && it->second.op != spv::Op::OpSpecConstant) ||
      it->second.operands.size() != 1 || type(it->second.type).kind != Type::Kind::Int)
    return std::nullopt;
  return it->second.operands[0];
}

std::string Module::name_of(Id id) const {
  const auto it = names.find(id);
  return it == names.end() || it->second.empty() ? fmt::format("%{}", id) : it->second;
}

const Function* Module::function(Id id) const {
  for (const Function& f : functions)
    if (f.id == id) return &f;
  return nullptr;
}

const EntryPoint& Module::entry_point(const std::string& wanted, const std::string& file) const {
  std::string known;
  for (const EntryPoint& entry : entry_points) {
    if (entry.name == wanted || (wanted.empty() && entry_points.size() == 1)) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  // Choice: of several entry points, an unnamed request gets "main", which is the only name that GLSL has.
  const auto is_main = [](const EntryPoint& entry) { return entry.name == "main"; };
  if (wanted.empty() && std::count_if(entry_points.begin(), entry_points.end(), is_main) == 1)
    return *std::find_if(entry_points.begin(), entry_points.end(), is_main);
  if (entry_points.empty()) throw UserError({file, 0, 0}, "the module has no entry point");
  throw UserError({file, 0, 0},
                  wanted.empty() ? "the module has several entry points: " + known
                                 : "the module has no entry point '" + wanted + "': it has " + known,
                  "choose one by its name");
}

std::vector<Id> Block::successors() const {
  if (code.empty()) return {};
  const Instruction& last = terminator();
  switch (last.op) {
    case spv::Op::OpBranch:
      return {last.operands[0]};
    case spv::Op::OpBranchConditional:
      return {last.operands[1], last.operands[2]};
    case spv::Op::OpSwitch: {
      std::vector<Id> to{last.operands[1]};
      for (size_t i = 2 + last.literal_words; i < last.operands.size(); i += 1 + last.literal_words)
        to.push_back(last.operands[i]);
      return to;
    }
    default:
      return {};
  }
}

}  // namespace glint::frontend
