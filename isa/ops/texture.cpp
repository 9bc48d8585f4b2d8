// Texture and surface ops: their handlers hand handle and coordinates to the texture unit.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Operands kSlot to kSlot + 2 are handle, u (or x) and v (or y); they are handed over as bits, for all lanes.
template <int kSlot>
[[gnu::flatten]] void form_texel_access(Warp& warp, const Inst& inst) {
  const Slot* const slot = &inst.operand.front() + kSlot;
  const Source<uint32_t> handle(warp, slot[0]), u(warp, slot[1]), v(warp, slot[2]);
  Access& access = warp.access;
  Address* const address_out = &access.address.front();
  uint32_t* const u_out = &access.u.front();
  uint32_t* const v_out = &access.v.front();
  all_lanes([&](int i) {
    address_out[i] = handle.at(i);
    u_out[i] = u.at(i);
    v_out[i] = v.at(i);
  });
}

constexpr OpRow texture(std::string_view name, Effect effect, Operands operands, Handler run,
                        std::string_view doc) {
  OpRow row = effect_op(name, Class::Tex, Unit::Tex, effect, operands, doc);
  row.memory = {Space::Global, 4, 4, false};
  row.run = run;
  return row;
}

constexpr OpRow kRows[] = {
    texture("tex.2d.v4.f32", Effect::Texture, {DstVec4, Src32, Src32, Src32}, &form_texel_access<4>,
            "Fetches a filtered texel: handle, then normalised float coordinates u and v."),
    texture("suld.2d.v4.b32", Effect::SurfaceLoad, {DstVec4, Src32, Src32, Src32}, &form_texel_access<4>,
            "Loads a texel of a storage image: handle, then integer coordinates x and y."),
    texture("sust.2d.v4.b32", Effect::SurfaceStore, {Src32, Src32, Src32, SrcVec4}, &form_texel_access<0>,
            "Stores a texel of a storage image: handle, integer coordinates x and y, then four words."),
};

}  // namespace

RowList texture_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
