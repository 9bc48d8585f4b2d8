// Defines parts of the rows of texture and surface ops: names of geometries, operands, the handler.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {

using enum ImageShape;

template <ImageShape kShape>
constexpr auto shape_text() {
  if constexpr (kShape == Buffer) return Text(".buffer");
  if constexpr (kShape == D1) return Text(".1d");
  if constexpr (kShape == D2) return Text(".2d");
  if constexpr (kShape == D3) return Text(".3d");
  if constexpr (kShape == A1d) return Text(".a1d");
  if constexpr (kShape == A2d) return Text(".a2d");
  if constexpr (kShape == Cube) return Text(".cube");
  if constexpr (kShape == Acube) return Text(".acube");
}

// Lists the operands of an image op, one after the other.
struct OperandList {
  Operands list;
  constexpr OperandList& add(OperandKind kind, int times = 1) {
    for (int i = 0; i < times; ++i) list.kind[list.count++] = kind;
    return *this;
  }
  // Adds handle, layer and coordinates.
  constexpr OperandList& add_place(ImageShape shape) {
    return add(Src32, 1 + int(has_layers(shape)) + num_coordinates(shape));
  }
};

// Passes on operand kSlot, the handle, for all lanes. The machine reads the other operands itself.
template <int kSlot>
[[gnu::flatten]] void form_image_access(Warp& warp, const Inst& inst, const OpRow&) {
  const Source<uint32_t> handle(warp, inst.operand[kSlot]);
  Address* const address_out = &warp.access.address.front();
  all_lanes([&](int i) { address_out[i] = handle.at(i); });
}

constexpr Handler handler_of(const Operands& operands) {
  const int first = operands.kind[0] == DstVec4                              ? 4
                    : operands.kind[0] == DstVec2                            ? 2
                    : operands.kind[0] == Dst32 || operands.kind[0] == Dst64 ? 1
                                                                             : 0;
  return first == 4   ? &form_image_access<4>
         : first == 2 ? &form_image_access<2>
         : first == 1 ? &form_image_access<1>
                      : &form_image_access<0>;
}

constexpr OpRow image_op(std::string_view name, Effect effect, const ImageAccess& image,
                         const Operands& operands, std::string_view doc) {
  OpRow row = effect_op(name, Class::Tex, Unit::Tex, effect, operands, doc);
  row.memory = {Space::Global, 4, 4, false};
  row.image = image;
  row.run = handler_of(operands);
  return row;
}

}  // namespace glint::isa::GLINT_ISA_PATH
