// Defines surface ops: loads, stores and atomics of single texels of storage images.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "isa/ops/effects/image_rows.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

template <ImageOutside kOutside>
constexpr auto outside_text() {
  if constexpr (kOutside == ImageOutside::Trap) return Text(".trap");
  if constexpr (kOutside == ImageOutside::Clamp) return Text(".clamp");
  if constexpr (kOutside == ImageOutside::Zero) return Text(".zero");
}
template <ImageOutside kOutside>
constexpr auto outside_doc() {
  if constexpr (kOutside == ImageOutside::Trap) return Text(" An access outside of the image is a fault.");
  if constexpr (kOutside == ImageOutside::Clamp)
    return Text(" An access outside of the image goes to the nearest texel.");
  if constexpr (kOutside == ImageOutside::Zero)
    return Text(" Outside of the image, loads give 0 and stores are dropped.");
}
template <ImageOutside kOutside>
constexpr ImageAccess access_of(ImageRequest request, ImageShape shape) {
  ImageAccess image{request, shape};
  image.outside = kOutside;
  return image;
}

// Makes suld.p and sust.p: four words, converted from and to the format of the image.
template <ImageOutside kOutside, ImageShape kShape>
constexpr std::array<OpRow, 2> texel_rows() {
  OperandList load, store;
  load.add(DstVec4).add_place(kShape);
  store.add_place(kShape).add(SrcVec4);
  const ImageAccess image = access_of<kOutside>(ImageRequest::Texel, kShape);
  return {image_op(joined<"suld.p", shape_text<kShape>(), ".v4.b32", outside_text<kOutside>()>,
                   Effect::SurfaceLoad, image, load.list,
                   joined<"Loads a texel and converts it from the image's format.", outside_doc<kOutside>()>),
          image_op(joined<"sust.p", shape_text<kShape>(), ".v4.b32", outside_text<kOutside>()>,
                   Effect::SurfaceStore, image, store.list,
                   joined<"Converts a texel to the image's format and stores it.", outside_doc<kOutside>()>)};
}

enum class Width { B8, B16, B32, V2, V4 };
template <Width kWidth>
constexpr auto width_text() {
  if constexpr (kWidth == Width::B8) return Text(".b8");
  if constexpr (kWidth == Width::B16) return Text(".b16");
  if constexpr (kWidth == Width::B32) return Text(".b32");
  if constexpr (kWidth == Width::V2) return Text(".v2.b32");
  if constexpr (kWidth == Width::V4) return Text(".v4.b32");
}

// Makes suld.b and sust.b, which do not convert bytes.
template <ImageOutside kOutside, ImageShape kShape, Width kWidth>
constexpr std::array<OpRow, 2> byte_rows() {
  OperandList load, store;
  load.add(kWidth == Width::V4 ? DstVec4 : kWidth == Width::V2 ? DstVec2 : Dst32).add_place(kShape);
  store.add_place(kShape).add(kWidth == Width::V4 ? SrcVec4 : kWidth == Width::V2 ? SrcVec2 : Src32);
  const ImageAccess image = access_of<kOutside>(ImageRequest::Bytes, kShape);
  std::array<OpRow, 2> rows = {
      image_op(
          joined<"suld.b", shape_text<kShape>(), width_text<kWidth>(), outside_text<kOutside>()>,
          Effect::SurfaceLoad, image, load.list,
          joined<"Loads bytes of an image without conversion. x counts bytes.", outside_doc<kOutside>()>),
      image_op(
          joined<"sust.b", shape_text<kShape>(), width_text<kWidth>(), outside_text<kOutside>()>,
          Effect::SurfaceStore, image, store.list,
          joined<"Stores bytes to an image without conversion. x counts bytes.", outside_doc<kOutside>()>)};
  for (OpRow& row : rows)
    row.memory = {Space::Global,
                  uint8_t(kWidth == Width::B8    ? 1
                          : kWidth == Width::B16 ? 2
                                                 : 4),
                  uint8_t(kWidth == Width::V4   ? 4
                          : kWidth == Width::V2 ? 2
                                                : 1),
                  false};
  return rows;
}

template <ImageOutside kOutside, ImageShape... kShapes>
constexpr auto accesses_of() {
  return joined_rows(
      texel_rows<kOutside, kShapes>()..., byte_rows<kOutside, kShapes, Width::B8>()...,
      byte_rows<kOutside, kShapes, Width::B16>()..., byte_rows<kOutside, kShapes, Width::B32>()...,
      byte_rows<kOutside, kShapes, Width::V2>()..., byte_rows<kOutside, kShapes, Width::V4>()...);
}

enum class Rmw { AddU32, AddS32, AddF32, MinU32, MinS32, MaxU32, MaxS32, And, Or, Xor, Exch, Cas };
template <Rmw kRmw>
constexpr auto rmw_name() {
  if constexpr (kRmw == Rmw::AddU32 || kRmw == Rmw::AddS32 || kRmw == Rmw::AddF32) return Text(".add");
  if constexpr (kRmw == Rmw::MinU32 || kRmw == Rmw::MinS32) return Text(".min");
  if constexpr (kRmw == Rmw::MaxU32 || kRmw == Rmw::MaxS32) return Text(".max");
  if constexpr (kRmw == Rmw::And) return Text(".and");
  if constexpr (kRmw == Rmw::Or) return Text(".or");
  if constexpr (kRmw == Rmw::Xor) return Text(".xor");
  if constexpr (kRmw == Rmw::Exch) return Text(".exch");
  if constexpr (kRmw == Rmw::Cas) return Text(".cas");
}
template <Rmw kRmw>
constexpr auto rmw_type() {
  if constexpr (kRmw == Rmw::AddU32 || kRmw == Rmw::MinU32 || kRmw == Rmw::MaxU32) return Text(".u32");
  if constexpr (kRmw == Rmw::AddS32 || kRmw == Rmw::MinS32 || kRmw == Rmw::MaxS32) return Text(".s32");
  if constexpr (kRmw == Rmw::AddF32) return Text(".f32");
  if constexpr (kRmw >= Rmw::And) return Text(".b32");
}

// Returns the new value in memory. Model: the sum of floats is rounded to nearest even and keeps subnormals.
template <Rmw kRmw>
uint64_t apply(uint64_t old, uint64_t operand, uint64_t swap) {
  const auto a = uint32_t(old), b = uint32_t(operand);
  const auto sa = int32_t(a), sb = int32_t(b);
  switch (kRmw) {
    case Rmw::AddU32:
    case Rmw::AddS32:
      return uint32_t(a + b);
    case Rmw::AddF32:
      return float_bits(canonical(float_of(a) + float_of(b)));
    case Rmw::MinU32:
      return a < b ? a : b;
    case Rmw::MinS32:
      return sa < sb ? a : b;
    case Rmw::MaxU32:
      return a > b ? a : b;
    case Rmw::MaxS32:
      return sa > sb ? a : b;
    case Rmw::And:
      return a & b;
    case Rmw::Or:
      return a | b;
    case Rmw::Xor:
      return a ^ b;
    case Rmw::Exch:
      return b;
    case Rmw::Cas:
      return a == b ? uint32_t(swap) : a;
  }
  return a;
}

template <Rmw kRmw>
constexpr auto where_doc() {
  if constexpr (kRmw == Rmw::Cas)
    return Text(" to the last operand if it equals the one before");
  else
    return Text("");
}

// Makes suatom, which is Glint's own op for Vulkan's image atomics: PTX has none that return the old value.
template <ImageShape kShape, Rmw kRmw>
constexpr OpRow atomic_row() {
  OperandList operands;
  operands.add(Dst32).add_place(kShape).add(Src32, kRmw == Rmw::Cas ? 2 : 1);
  OpRow row = image_op(joined<"suatom.p", rmw_name<kRmw>(), shape_text<kShape>(), rmw_type<kRmw>(), ".trap">,
                       Effect::SurfaceAtomic, access_of<ImageOutside::Trap>(ImageRequest::Texel, kShape),
                       operands.list,
                       joined<"Changes a texel of 32 bits", where_doc<kRmw>(),
                              " and returns its old value. Lanes take turns, the lowest first.">);
  row.memory = {Space::Global, 4, 1, false};
  row.atomic = &apply<kRmw>;
  return row;
}
template <ImageShape kShape, Rmw... kRmw>
constexpr std::array<OpRow, sizeof...(kRmw)> atomics_of() {
  return {atomic_row<kShape, kRmw>()...};
}
template <ImageShape... kShapes>
constexpr auto atomics() {
  return joined_rows(
      atomics_of<kShapes, Rmw::AddU32, Rmw::AddS32, Rmw::AddF32, Rmw::MinU32, Rmw::MinS32, Rmw::MaxU32,
                 Rmw::MaxS32, Rmw::And, Rmw::Or, Rmw::Xor, Rmw::Exch, Rmw::Cas>()...);
}

constexpr uint64_t swap_if_equal(uint64_t old, uint64_t expected, uint64_t swap) {
  return old == expected ? swap : old;
}

// Makes the atomic for texels of 64 bits. All other atomics on such texels are loops of it.
template <ImageShape kShape>
constexpr OpRow wide_atomic_row() {
  OperandList operands;
  operands.add(Dst64).add_place(kShape).add(Src64, 2);
  OpRow row = image_op(joined<"suatom.p.cas", shape_text<kShape>(), ".b64.trap">, Effect::SurfaceAtomic,
                       access_of<ImageOutside::Trap>(ImageRequest::Texel, kShape), operands.list,
                       "Changes a texel of 64 bits to the last operand if it equals the one before, and "
                       "returns its old value.");
  row.memory = {Space::Global, 8, 1, false};
  row.atomic = &swap_if_equal;
  return row;
}
template <ImageShape... kShapes>
constexpr std::array<OpRow, sizeof...(kShapes)> wide_atomics() {
  return {wide_atomic_row<kShapes>()...};
}

// Makes sured.b, which is like suatom, but has x in bytes and no result.
template <ImageOutside kOutside, ImageShape kShape, Rmw kRmw>
constexpr OpRow reduction_row() {
  OperandList operands;
  operands.add_place(kShape).add(Src32);
  OpRow row = image_op(
      joined<"sured.b", rmw_name<kRmw>(), shape_text<kShape>(), rmw_type<kRmw>(), outside_text<kOutside>()>,
      Effect::SurfaceAtomic, access_of<kOutside>(ImageRequest::Bytes, kShape), operands.list,
      joined<"Changes 32 bits of an image. x counts bytes.", outside_doc<kOutside>()>);
  row.memory = {Space::Global, 4, 1, false};
  row.atomic = &apply<kRmw>;
  return row;
}
template <ImageOutside kOutside, ImageShape kShape, Rmw... kRmw>
constexpr std::array<OpRow, sizeof...(kRmw)> reductions_of() {
  return {reduction_row<kOutside, kShape, kRmw>()...};
}
template <ImageOutside kOutside, ImageShape... kShapes>
constexpr auto reductions() {
  return joined_rows(reductions_of<kOutside, kShapes, Rmw::AddU32, Rmw::AddS32, Rmw::MinU32, Rmw::MinS32,
                                   Rmw::MaxU32, Rmw::MaxS32, Rmw::And, Rmw::Or>()...);
}

constexpr OpRow query(std::string_view name, ImageQuery what, std::string_view doc) {
  ImageAccess image{ImageRequest::Query};
  image.query = what;
  return image_op(name, Effect::ImageQuery, image, {Dst32, Src32}, doc);
}
constexpr std::array kQueries = {
    query("suq.width.b32", ImageQuery::Width, "Returns the width of a storage image in texels."),
    query("suq.height.b32", ImageQuery::Height,
          "Returns the height of a storage image in texels, or 1 when it has one dimension."),
    query("suq.depth.b32", ImageQuery::Depth,
          "Returns the depth of a storage image in texels, or 1 unless it has three dimensions."),
    query("suq.array_size.b32", ImageQuery::ArraySize,
          "Returns the number of layers of a storage image, which for cubes is the number of cubes."),
    query("suq.channel_data_type.b32", ImageQuery::ChannelDataType,
          "Returns OpenCL's number of the channels' type, or 0 if it has none."),
    query("suq.channel_order.b32", ImageQuery::ChannelOrder,
          "Returns OpenCL's number of the channels' order."),
};

constexpr auto kRows = joined_rows(
    accesses_of<ImageOutside::Trap, D1, D2, D3, A1d, A2d>(),
    accesses_of<ImageOutside::Clamp, D1, D2, D3, A1d, A2d>(),
    accesses_of<ImageOutside::Zero, D1, D2, D3, A1d, A2d>(), texel_rows<ImageOutside::Trap, Buffer>(),
    atomics<Buffer, D1, D2, D3, A1d, A2d>(), wide_atomics<Buffer, D1, D2, D3, A1d, A2d>(),
    reductions<ImageOutside::Trap, D1, D2, D3>(), reductions<ImageOutside::Clamp, D1, D2, D3>(),
    reductions<ImageOutside::Zero, D1, D2, D3>(), kQueries);

}  // namespace

RowList surface_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
