// Defines texture ops: filtered fetches, texel fetches, gathers and queries. Their handlers pass the handle
// to the texture unit.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "isa/ops/effects/image_rows.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

enum class Data { F32, S32, U32 };
template <Data kData>
constexpr auto data_text() {
  if constexpr (kData == Data::F32) return Text(".f32");
  if constexpr (kData == Data::S32) return Text(".s32");
  if constexpr (kData == Data::U32) return Text(".u32");
}

template <ImageLod kLod>
constexpr auto lod_text() {
  if constexpr (kLod == ImageLod::Zero) return Text("");
  if constexpr (kLod == ImageLod::Level) return Text(".level");
  if constexpr (kLod == ImageLod::Gradients) return Text(".grad");
}
template <ImageLod kLod>
constexpr auto lod_doc() {
  if constexpr (kLod == ImageLod::Zero) return Text("");
  if constexpr (kLod == ImageLod::Level) return Text(", level of detail");
  if constexpr (kLod == ImageLod::Gradients) return Text(", gradients of the coordinates in x, then in y");
}
template <bool kIs, Text kYes>
constexpr auto text_if() {
  if constexpr (kIs)
    return kYes;
  else
    return Text("");
}
template <ImageShape kShape>
constexpr auto place_doc() {
  if constexpr (has_layers(kShape))
    return Text("handle, layer, coordinates");
  else
    return Text("handle, coordinates");
}

// Gives the part after the geometry in a name, and after the place in a sentence.
template <bool kCompare, bool kOffset>
constexpr auto forms_text() {
  return Joined<text_if<kCompare, ".compare">(), text_if<kOffset, ".offset">()>::kAsText;
}
template <bool kCompare, bool kOffset>
constexpr auto forms_doc() {
  return Joined<text_if<kOffset, ", texel offsets (bytes x, y, z)">(),
                text_if<kCompare, ", reference value">()>::kAsText;
}

template <ImageLod kLod, bool kCompare, bool kOffset, Data kData, ImageShape kShape>
constexpr OpRow sample_row() {
  OperandList operands;
  operands.add(kCompare ? Dst32 : DstVec4).add_place(kShape);
  if (kLod == ImageLod::Level) operands.add(Src32);
  if (kLod == ImageLod::Gradients) operands.add(Src32, 2 * num_coordinates(kShape));
  operands.add(Src32, int(kOffset) + int(kCompare));
  ImageAccess image{ImageRequest::Sample, kShape, kLod, kData == Data::F32, kOffset, kCompare};
  return image_op(
      joined<"tex", lod_text<kLod>(), forms_text<kCompare, kOffset>(), shape_text<kShape>(),
             text_if<!kCompare, ".v4">(), data_text<kData>(), ".f32">,
      Effect::Texture, image, operands.list,
      joined<text_if<kCompare, "Filters comparisons of texels with a reference. The operands are ">(),
             text_if<!kCompare, "Filters texels. The operands are ">(), place_doc<kShape>(), lod_doc<kLod>(),
             forms_doc<kCompare, kOffset>(), ".">);
}

template <ImageLod kLod, Data kData, ImageShape kShape>
constexpr OpRow fetch_row() {
  OperandList operands;
  operands.add(DstVec4).add_place(kShape).add(Src32, int(kLod == ImageLod::Level));
  ImageAccess image{ImageRequest::Fetch, kShape, kLod, kData == Data::F32};
  return image_op(joined<"tex", lod_text<kLod>(), shape_text<kShape>(), ".v4", data_text<kData>(), ".s32">,
                  Effect::Texture, image, operands.list,
                  joined<"Reads one texel without filtering. The operands are ", place_doc<kShape>(),
                         " counted in texels", text_if<kLod == ImageLod::Level, ", level">(), ".">);
}

template <uint8_t kComponent, bool kCompare, bool kOffset, Data kData, ImageShape kShape>
constexpr OpRow gather_row() {
  constexpr Text kName = kComponent == 0   ? Text(".r")
                         : kComponent == 1 ? Text(".g")
                         : kComponent == 2 ? Text(".b")
                                           : Text(".a");
  OperandList operands;
  operands.add(DstVec4).add_place(kShape).add(Src32, int(kOffset) + int(kCompare));
  ImageAccess image{
      ImageRequest::Gather, kShape, ImageLod::Zero, kData == Data::F32, kOffset, kCompare, kComponent};
  return image_op(
      joined<"tld4", forms_text<kCompare, kOffset>(), kName, shape_text<kShape>(), ".v4", data_text<kData>(),
             ".f32">,
      Effect::Texture, image, operands.list,
      joined<
          text_if<kCompare, "Compares the four texels that a linear filter reads. The operands are ">(),
          text_if<!kCompare,
                  "Gathers one component of the four texels that a linear filter reads. The operands are ">(),
          place_doc<kShape>(), forms_doc<kCompare, kOffset>(), ".">);
}

template <ImageLod kLod, bool kOffset, Data kData, ImageShape... kShapes>
constexpr std::array<OpRow, sizeof...(kShapes)> samples_of() {
  return {sample_row<kLod, false, kOffset, kData, kShapes>()...};
}
template <ImageLod kLod>
constexpr auto sample_rows() {
  return joined_rows(samples_of<kLod, false, Data::F32, D1, D2, D3, A1d, A2d, Cube, Acube>(),
                     samples_of<kLod, false, Data::S32, D1, D2, D3, A1d, A2d, Cube, Acube>(),
                     samples_of<kLod, false, Data::U32, D1, D2, D3, A1d, A2d, Cube, Acube>(),
                     samples_of<kLod, true, Data::F32, D1, D2, D3, A1d, A2d>(),
                     samples_of<kLod, true, Data::S32, D1, D2, D3, A1d, A2d>(),
                     samples_of<kLod, true, Data::U32, D1, D2, D3, A1d, A2d>());
}

template <ImageLod kLod, bool kOffset, ImageShape... kShapes>
constexpr std::array<OpRow, sizeof...(kShapes)> comparisons_of() {
  return {sample_row<kLod, true, kOffset, Data::F32, kShapes>()...};
}
template <ImageLod kLod>
constexpr auto comparison_rows() {
  return joined_rows(comparisons_of<kLod, false, D1, D2, A1d, A2d, Cube, Acube>(),
                     comparisons_of<kLod, true, D1, D2, A1d, A2d>());
}

template <ImageLod kLod, ImageShape... kShapes>
constexpr std::array<OpRow, 3 * sizeof...(kShapes)> fetches_of() {
  return {fetch_row<kLod, Data::F32, kShapes>()..., fetch_row<kLod, Data::S32, kShapes>()...,
          fetch_row<kLod, Data::U32, kShapes>()...};
}

template <bool kCompare, bool kOffset, Data kData, uint8_t kComponent, ImageShape... kShapes>
constexpr std::array<OpRow, sizeof...(kShapes)> gathers_of() {
  return {gather_row<kComponent, kCompare, kOffset, kData, kShapes>()...};
}
template <Data kData, uint8_t... kComponents>
constexpr auto gather_rows() {
  return joined_rows(gathers_of<false, false, kData, kComponents, D2, A2d, Cube, Acube>()...,
                     gathers_of<false, true, kData, kComponents, D2, A2d>()...);
}

constexpr OpRow query(std::string_view name, ImageQuery what, std::string_view doc,
                      ImageLod lod = ImageLod::Zero) {
  ImageAccess image{ImageRequest::Query};
  image.lod = lod;
  image.query = what;
  OperandList operands;
  operands.add(Dst32).add(Src32, lod == ImageLod::Level ? 2 : 1);
  return image_op(name, Effect::ImageQuery, image, operands.list, doc);
}

constexpr std::array kQueries = {
    query("txq.width.b32", ImageQuery::Width, "Returns the width of a texture in texels."),
    query("txq.height.b32", ImageQuery::Height,
          "Returns the height of a texture in texels, or 1 when it has one dimension."),
    query("txq.depth.b32", ImageQuery::Depth,
          "Returns the depth of a texture in texels, or 1 unless it has three dimensions."),
    query("txq.level.width.b32", ImageQuery::Width, "Returns the width of a level (handle, level).",
          ImageLod::Level),
    query("txq.level.height.b32", ImageQuery::Height, "Returns the height of a level (handle, level).",
          ImageLod::Level),
    query("txq.level.depth.b32", ImageQuery::Depth, "Returns the depth of a level (handle, level).",
          ImageLod::Level),
    query("txq.array_size.b32", ImageQuery::ArraySize,
          "Returns the number of layers of a texture, which for cubes is the number of cubes."),
    query("txq.num_mipmap_levels.b32", ImageQuery::NumMipmapLevels,
          "Returns the number of levels of a texture."),
    query("txq.num_samples.b32", ImageQuery::NumSamples, "Returns the number of samples of a texel."),
    query("txq.normalized_coords.b32", ImageQuery::NormalizedCoords,
          "Returns 1 when coordinates go from 0 to 1, and 0 when they count texels."),
    query("txq.channel_data_type.b32", ImageQuery::ChannelDataType,
          "Returns OpenCL's number of the channels' type, or 0 if it has none."),
    query("txq.channel_order.b32", ImageQuery::ChannelOrder,
          "Returns OpenCL's number of the channels' order."),
};

constexpr auto kRows = joined_rows(
    sample_rows<ImageLod::Zero>(), sample_rows<ImageLod::Level>(), sample_rows<ImageLod::Gradients>(),
    comparison_rows<ImageLod::Zero>(), comparison_rows<ImageLod::Level>(),
    comparison_rows<ImageLod::Gradients>(), fetches_of<ImageLod::Zero, Buffer, D1, D2, D3, A1d, A2d>(),
    fetches_of<ImageLod::Level, D1, D2, D3, A1d, A2d>(), gather_rows<Data::F32, 0, 1, 2, 3>(),
    gather_rows<Data::S32, 0, 1, 2, 3>(), gather_rows<Data::U32, 0, 1, 2, 3>(),
    gathers_of<true, false, Data::F32, 0, D2, A2d, Cube, Acube>(),
    gathers_of<true, true, Data::F32, 0, D2, A2d>(), kQueries);

}  // namespace

RowList texture_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
