// Defines rays that a shader walks itself, candidate by candidate (SPV_KHR_ray_query).
// SPDX-License-Identifier: Apache-2.0
#include "isa/ray_query.h"

#include <string_view>

#include "isa/ops/families.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow query(std::string_view name, Effect effect, Query detail, Operands operands,
                      std::string_view doc) {
  OpRow row = effect_op(name, Class::Rt, Unit::RtUnit, effect, operands, doc);
  row.detail = detail_of(detail);
  return row;
}

constexpr auto kSteps = joined_rows(
    query("rq.initialize", Effect::Query, Query::Initialize,
          {Src32, Src64, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32},
          "Starts a ray (query, structure, flags, mask, origin, tmin, direction, tmax)."),
    query("rq.proceed", Effect::QueryProceed, Query::Initialize, {DstPred, Src32},
          "Gives the ray of a query to the RT unit, and tells whether there is a new candidate. "
          "An undecided candidate is ignored."),
    query("rq.confirm", Effect::Query, Query::Confirm, {Src32}, "Commits the candidate triangle."),
    query("rq.generate", Effect::Query, Query::Generate, {Src32, Src32},
          "Commits a hit at t (second operand) in the candidate box, if t is in the ray's "
          "interval."),
    query("rq.terminate", Effect::Query, Query::Terminate, {Src32},
          "Ends the traversal. The committed hit stays."));

constexpr OpRow value(std::string_view name, Query field, int element, bool committed, std::string_view doc) {
  OpRow row = effect_op(name, Class::Rt, Unit::RtUnit, Effect::Query, {Dst32, Src32}, doc);
  row.detail = detail_of(field, committed, element);
  return row;
}

constexpr auto kValues = joined_rows(
    value("rq.type.candidate", Query::Type, 0, false,
          "Returns the kind of the candidate: 0 triangle, 1 box."),
    value("rq.type.committed", Query::Type, 0, true,
          "Returns the kind of the committed hit: 0 none, 1 triangle, 2 generated."),
    value("rq.t.candidate", Query::T, 0, false, "Returns the distance of the candidate triangle."),
    value("rq.t.committed", Query::T, 0, true,
          "Returns the distance of the committed hit, or the ray's end when there is none."),
    value("rq.aabb_opaque.candidate", Query::AabbOpaque, 0, false,
          "Returns 1 if the candidate box is opaque, else 0."),
    value("rq.tmin", Query::Tmin, 0, false, "Returns the beginning of the ray's interval."),
    value("rq.flags", Query::Flags, 0, false, "Returns the flags of the ray."),
    value("rq.origin.x", Query::Origin, 0, false, "Returns the ray's origin in world space."),
    value("rq.origin.y", Query::Origin, 1, false, "Returns the ray's origin in world space."),
    value("rq.origin.z", Query::Origin, 2, false, "Returns the ray's origin in world space."),
    value("rq.direction.x", Query::Direction, 0, false, "Returns the ray's direction in world space."),
    value("rq.direction.y", Query::Direction, 1, false, "Returns the ray's direction in world space."),
    value("rq.direction.z", Query::Direction, 2, false, "Returns the ray's direction in world space."));

// Makes rows that exist for the candidate and for the committed hit.
template <Text kName>
constexpr std::array<OpRow, 2> of_both(Query field, int element, std::string_view doc) {
  return {value(joined<"rq.", kName, ".candidate">, field, element, false, doc),
          value(joined<"rq.", kName, ".committed">, field, element, true, doc)};
}

template <int kNumber>
constexpr auto decimal() {
  if constexpr (kNumber < 10) {
    const char text[2] = {char('0' + kNumber), '\0'};
    return Text<2>(text);
  } else {
    const char text[3] = {char('0' + kNumber / 10), char('0' + kNumber % 10), '\0'};
    return Text<3>(text);
  }
}
template <Text kName, int kCount = 12>
constexpr std::array<OpRow, 2 * kCount> numbers_of_both(Query field, std::string_view doc) {
  std::array<OpRow, 2 * kCount> out;
  const auto element = [&]<int kElement>(std::integral_constant<int, kElement>) {
    const auto rows = of_both<Joined<kName, ".", decimal<kElement>()>::kAsText>(field, kElement, doc);
    out[2 * kElement] = rows[0];
    out[2 * kElement + 1] = rows[1];
  };
  [&]<int... kElement>(std::integer_sequence<int, kElement...>) {
    (element(std::integral_constant<int, kElement>{}), ...);
  }
  (std::make_integer_sequence<int, kCount>{});
  return out;
}

constexpr auto kRows = joined_rows(
    kSteps, kValues, of_both<"instance">(Query::Instance, 0, "Returns the index of the instance."),
    of_both<"custom">(Query::CustomIndex, 0, "Returns the custom index of the instance."),
    of_both<"sbt_offset">(Query::SbtOffset, 0, "Returns the binding-table offset of the instance."),
    of_both<"geometry">(Query::Geometry, 0, "Returns the index of the geometry."),
    of_both<"primitive">(Query::Primitive, 0, "Returns the index of the triangle or box."),
    of_both<"u">(Query::BarycentricU, 0, "Returns the weight of the triangle's second vertex."),
    of_both<"v">(Query::BarycentricV, 0, "Returns the weight of the triangle's third vertex."),
    of_both<"front_face">(Query::FrontFace, 0, "Returns 1 if the triangle faces the ray, else 0."),
    of_both<"object.origin.x">(Query::ObjectOrigin, 0, "Returns the ray's origin in object space."),
    of_both<"object.origin.y">(Query::ObjectOrigin, 1, "Returns the ray's origin in object space."),
    of_both<"object.origin.z">(Query::ObjectOrigin, 2, "Returns the ray's origin in object space."),
    of_both<"object.direction.x">(Query::ObjectDirection, 0, "Returns the ray's direction in object space."),
    of_both<"object.direction.y">(Query::ObjectDirection, 1, "Returns the ray's direction in object space."),
    of_both<"object.direction.z">(Query::ObjectDirection, 2, "Returns the ray's direction in object space."),
    numbers_of_both<"object_to_world">(Query::ObjectToWorld,
                                       "Returns an element of the instance's transform, row-major 3x4."),
    numbers_of_both<"world_to_object">(Query::WorldToObject,
                                       "Returns an element of the inverse transform, row-major 3x4."),
    numbers_of_both<"corner", 9>(
        Query::Corner,
        "Returns a coordinate of a corner of the triangle in object space, in the order x, y, z."));

}  // namespace

RowList ray_query_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH
