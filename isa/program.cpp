// Compares programs, and names their stages and specials.
// SPDX-License-Identifier: Apache-2.0
#include "isa/program.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "isa/op_row.h"
#include "isa/text.h"

namespace glint::isa {
namespace {

constexpr std::array<std::string_view, kNumSpecials> kSpecialNames = {"%laneid",
                                                                      "%launch.x",
                                                                      "%launch.y",
                                                                      "%launch.z",
                                                                      "%launch.size.x",
                                                                      "%launch.size.y",
                                                                      "%launch.size.z",
                                                                      "%tid.x",
                                                                      "%tid.y",
                                                                      "%tid.z",
                                                                      "%ntid.x",
                                                                      "%ntid.y",
                                                                      "%ntid.z",
                                                                      "%ctaid.x",
                                                                      "%ctaid.y",
                                                                      "%ctaid.z",
                                                                      "%nctaid.x",
                                                                      "%nctaid.y",
                                                                      "%nctaid.z",
                                                                      "%warpid",
                                                                      "%nwarpid",
                                                                      "%smid",
                                                                      "%nsmid",
                                                                      "%gridid",
                                                                      "%lanemask_eq",
                                                                      "%lanemask_le",
                                                                      "%lanemask_lt",
                                                                      "%lanemask_ge",
                                                                      "%lanemask_gt",
                                                                      "%total_smem_size",
                                                                      "%dynamic_smem_size",
                                                                      "%clock",
                                                                      "%clock_hi",
                                                                      "%globaltimer_lo",
                                                                      "%globaltimer_hi",
                                                                      "%payload",
                                                                      "%attribute",
                                                                      "%record",
                                                                      "%record_hi",
                                                                      "%hit.t",
                                                                      "%hit.kind",
                                                                      "%hit.u",
                                                                      "%hit.v",
                                                                      "%hit.primitive",
                                                                      "%hit.geometry",
                                                                      "%hit.instance",
                                                                      "%hit.custom",
                                                                      "%ray.flags",
                                                                      "%ray.tmin",
                                                                      "%ray.mask",
                                                                      "%ray.origin.x",
                                                                      "%ray.origin.y",
                                                                      "%ray.origin.z",
                                                                      "%ray.direction.x",
                                                                      "%ray.direction.y",
                                                                      "%ray.direction.z",
                                                                      "%object.origin.x",
                                                                      "%object.origin.y",
                                                                      "%object.origin.z",
                                                                      "%object.direction.x",
                                                                      "%object.direction.y",
                                                                      "%object.direction.z",
                                                                      "%object_to_world.0",
                                                                      "%object_to_world.1",
                                                                      "%object_to_world.2",
                                                                      "%object_to_world.3",
                                                                      "%object_to_world.4",
                                                                      "%object_to_world.5",
                                                                      "%object_to_world.6",
                                                                      "%object_to_world.7",
                                                                      "%object_to_world.8",
                                                                      "%object_to_world.9",
                                                                      "%object_to_world.10",
                                                                      "%object_to_world.11",
                                                                      "%world_to_object.0",
                                                                      "%world_to_object.1",
                                                                      "%world_to_object.2",
                                                                      "%world_to_object.3",
                                                                      "%world_to_object.4",
                                                                      "%world_to_object.5",
                                                                      "%world_to_object.6",
                                                                      "%world_to_object.7",
                                                                      "%world_to_object.8",
                                                                      "%world_to_object.9",
                                                                      "%world_to_object.10",
                                                                      "%world_to_object.11"};
static_assert(!kSpecialNames.back().empty(), "every special has a name");

constexpr std::string_view kStageNames[] = {"ray_generation", "intersection", "any_hit", "closest_hit",
                                            "miss",           "callable",     "compute"};
static_assert(std::size(kStageNames) == size_t(kNumStages));

bool same_inst(const Inst& a, const Inst& b) {
  return a.op == b.op && a.guard == b.guard && a.imm == b.imm && a.operand == b.operand;
}

}  // namespace

bool Program::operator==(const Program& o) const {
  return name == o.name && stage == o.stage && constants == o.constants && files == o.files &&
         lines == o.lines && num_registers == o.num_registers && local_bytes == o.local_bytes &&
         function == o.function && payload_bytes == o.payload_bytes && attribute_bytes == o.attribute_bytes &&
         local_size == o.local_size && shared_bytes == o.shared_bytes && messages == o.messages &&
         std::equal(code.begin(), code.end(), o.code.begin(), o.code.end(), same_inst);
}

std::string_view name_of(Special special) {
  return kSpecialNames[size_t(special)];
}

Special find_special(std::string_view name) {
  return Special(std::find(kSpecialNames.begin(), kSpecialNames.end(), name) - kSpecialNames.begin());
}

std::string_view name_of(Stage stage) {
  return kStageNames[size_t(stage)];
}

bool find_stage(std::string_view name, Stage& out) {
  const auto at = std::find(std::begin(kStageNames), std::end(kStageNames), name);
  if (at == std::end(kStageNames)) return false;
  out = Stage(at - std::begin(kStageNames));
  return true;
}

SpecialSet specials_read_by(std::span<const Inst> code) {
  SpecialSet used;
  for (const Inst& inst : code) {
    int slot = 0;
    for (const OperandKind kind : op_table()[inst.op].operands.view()) {
      const int end = slot + slots_of(kind);
      if (kind == OperandKind::DstPred || kind == OperandKind::SrcPred) slot = end;
      for (; slot < end; ++slot)
        if (inst.operand[slot] & kSpecialBank) used.set(inst.operand[slot] & kSlotIndexMask);
    }
  }
  return used;
}

uint32_t intern_constant(std::vector<uint32_t>& rows, uint64_t value, bool is_wide) {
  const uint32_t low = uint32_t(value), high = uint32_t(value >> 32);
  const size_t width = is_wide ? 2 : 1;
  for (size_t i = 0; i + width <= rows.size(); ++i)
    if (rows[i] == low && (!is_wide || rows[i + 1] == high)) return uint32_t(i);
  rows.push_back(low);
  if (is_wide) rows.push_back(high);
  return uint32_t(rows.size() - width);
}

}  // namespace glint::isa
