// Lowers ray queries (SPV_KHR_ray_query): each instruction becomes one ISA op, or one op for each scalar of
// its result.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/spirv/known_positions.h"
#include "frontend/spirv/spirv.h"

namespace glint::frontend {
namespace {

// Returns the number of a query among those of the shader.
Operand query(ModuleLowering& l, const Instruction& inst) {
  const Pointer p = l.pointer(inst.operands[0]);
  if (p.space != PointerSpace::RayQuery) l.unsupported("a ray query that is not a variable of a function");
  return p.base;
}

void initialize(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  Operands operands{query(l, inst)};
  // The operands are: structure, flags, mask, origin, t min, direction, t max.
  for (size_t i = 1; i < inst.operands.size(); ++i) {
    const Operands parts = l.value(inst.operands[i]);
    operands.insert(operands.end(), parts.begin(), parts.end());
  }
  l.emit().effect("rq.initialize", std::move(operands));
}

void proceed(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  l.set(inst.result, {l.emit().fresh("rq.proceed", {query(l, inst)})});
}

void decide(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.emit().effect(row.name32, {query(l, inst)});
}

void generate(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.emit().effect(row.name32, {query(l, inst), l.scalar(inst.operands[1])});
}

// Returns ".candidate" or ".committed", by the constant of SPIR-V's Intersection operand.
std::string suffix(const ModuleLowering& l, const Instruction& inst) {
  return l.module().constant_u32(inst.operands[1]).value_or(0) % kPositionsOfIntersection ? ".committed"
                                                                                          : ".candidate";
}

// Lowers a query of one scalar of a hit, or of the ray itself.
void of_hit(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, {l.emit().fresh(std::string(row.name32) + suffix(l, inst), {query(l, inst)})});
}
void of_ray(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, {l.emit().fresh(row.name32, {query(l, inst)})});
}

Operand as_bool(ModuleLowering& l, const std::string& op, const Operand& which) {
  return l.emit().value("setp.ne.u32", {l.emit().fresh(op, {which}), Operand::value(0)});
}
void front_face(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, {as_bool(l, std::string(row.name32) + suffix(l, inst), query(l, inst))});
}
void aabb_opaque(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, {as_bool(l, std::string(row.name32), query(l, inst))});
}

void barycentrics(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operand which = query(l, inst);
  l.set(inst.result, {l.emit().fresh("rq.u" + suffix(l, inst), {which}),
                      l.emit().fresh("rq.v" + suffix(l, inst), {which})});
}

Operands vector(ModuleLowering& l, const std::string& stem, const std::string& end, const Operand& which) {
  Operands parts;
  for (const char* axis : {".x", ".y", ".z"}) parts.push_back(l.emit().fresh(stem + axis + end, {which}));
  return parts;
}
void vector_of_hit(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, vector(l, std::string(row.name32), suffix(l, inst), query(l, inst)));
}
void vector_of_ray(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  l.set(inst.result, vector(l, std::string(row.name32), "", query(l, inst)));
}

// Returns a matrix, GLSL's mat4x3: four columns of three rows. The ISA numbers its values row by row. The
// corners of a triangle are the first three columns of such a matrix (known_positions.h).
void matrix_of_hit(ModuleLowering& l, const Instruction& inst, const LoweringRow& row) {
  const Operand which = query(l, inst);
  Operands parts;
  if (l.module().constant_u32(inst.operands[1]).value_or(0) >= kPositionsOfIntersection) {
    for (int number = 0; number < 12; ++number)
      parts.push_back(number < 9
                          ? l.emit().fresh("rq.corner." + std::to_string(number) + suffix(l, inst), {which})
                          : Operand::value(0));
    return l.set(inst.result, std::move(parts));
  }
  for (int column = 0; column < 4; ++column)
    for (int r = 0; r < 3; ++r)
      parts.push_back(l.emit().fresh(
          std::string(row.name32) + "." + std::to_string(4 * r + column) + suffix(l, inst), {which}));
  l.set(inst.result, std::move(parts));
}

using enum spv::Op;
constexpr LoweringRow kRayQueryRows[] = {
    {OpRayQueryInitializeKHR, initialize, ""},
    {OpRayQueryProceedKHR, proceed, ""},
    {OpRayQueryConfirmIntersectionKHR, decide, "rq.confirm"},
    {OpRayQueryTerminateKHR, decide, "rq.terminate"},
    {OpRayQueryGenerateIntersectionKHR, generate, "rq.generate"},
    {OpRayQueryGetIntersectionTypeKHR, of_hit, "rq.type"},
    {OpRayQueryGetIntersectionTKHR, of_hit, "rq.t"},
    {OpRayQueryGetIntersectionInstanceIdKHR, of_hit, "rq.instance"},
    {OpRayQueryGetIntersectionInstanceCustomIndexKHR, of_hit, "rq.custom"},
    {OpRayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetKHR, of_hit, "rq.sbt_offset"},
    {OpRayQueryGetIntersectionGeometryIndexKHR, of_hit, "rq.geometry"},
    {OpRayQueryGetIntersectionPrimitiveIndexKHR, of_hit, "rq.primitive"},
    {OpRayQueryGetIntersectionBarycentricsKHR, barycentrics, ""},
    {OpRayQueryGetIntersectionFrontFaceKHR, front_face, "rq.front_face"},
    {OpRayQueryGetIntersectionCandidateAABBOpaqueKHR, aabb_opaque, "rq.aabb_opaque.candidate"},
    {OpRayQueryGetIntersectionObjectRayOriginKHR, vector_of_hit, "rq.object.origin"},
    {OpRayQueryGetIntersectionObjectRayDirectionKHR, vector_of_hit, "rq.object.direction"},
    {OpRayQueryGetIntersectionObjectToWorldKHR, matrix_of_hit, "rq.object_to_world"},
    {OpRayQueryGetIntersectionWorldToObjectKHR, matrix_of_hit, "rq.world_to_object"},
    {OpRayQueryGetRayTMinKHR, of_ray, "rq.tmin"},
    {OpRayQueryGetRayFlagsKHR, of_ray, "rq.flags"},
    {OpRayQueryGetWorldRayOriginKHR, vector_of_ray, "rq.origin"},
    {OpRayQueryGetWorldRayDirectionKHR, vector_of_ray, "rq.direction"},
};

}  // namespace

uint32_t ModuleLowering::ray_query(Id variable) {
  if (const auto it = ray_queries_.find(variable); it != ray_queries_.end()) return it->second;
  uint32_t count = 1;
  const Type* type = &module_.type(module_.type(type_of(variable)).element);
  for (; type->kind == Type::Kind::Array; type = &module_.type(type->element)) count *= type->count;
  const uint32_t first = num_ray_queries_;
  num_ray_queries_ += count;
  return ray_queries_[variable] = first;
}

std::span<const LoweringRow> ray_query_rows() {
  return kRayQueryRows;
}

}  // namespace glint::frontend
