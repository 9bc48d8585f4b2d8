// Defines hit objects: a shader keeps what a ray found until it has the hit's shader executed.
// SPDX-License-Identifier: Apache-2.0
#include "isa/hit_object.h"

#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow object(std::string_view name, HitObjectOp detail, Operands operands, std::string_view doc) {
  OpRow row = effect_op(name, Class::Rt, Unit::RtUnit, Effect::HitObject, operands, doc);
  row.detail = uint16_t(detail);
  return row;
}

constexpr OpRow reorder(std::string_view name, HitObjectOp detail, Operands operands, std::string_view doc) {
  OpRow row = object(name, detail, operands, doc);
  row.effect = Effect::Reorder;
  return row;
}

constexpr OpRow execute() {
  OpRow row = effect_op(
      "ho.execute", Class::Rt, Unit::RtUnit, Effect::Trace, {Src32, Src32, Src32},
      "Opens a trace that has found what an object holds (object, payload, attributes). call.sbt.hit and "
      "rt.end must follow.");
  row.detail = uint16_t(TraceKind::HitObject);
  return row;
}

constexpr OpRow kRows[] = {
    object("ho.record", HitObjectOp::Record, {Src32},
           "Keeps what the innermost trace has found in an object."),
    object("ho.empty", HitObjectOp::Empty, {Src32}, "Makes an object empty."),
    object("ho.miss", HitObjectOp::Miss,
           {Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32},
           "Makes an object a miss (object, miss index, origin, tmin, direction, tmax)."),
    object("ho.hit", HitObjectOp::Hit,
           {Src32, Src64, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32,
            Src32, Src32, Src32},
           "Makes an object a hit (object, structure, instance, primitive, geometry, kind, SBT offset, SBT "
           "stride, origin, tmin, direction, tmax, local address of the attributes)."),
    object("ho.hit.record", HitObjectOp::HitAtRecord,
           {Src32, Src64, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32,
            Src32, Src32},
           "Does what ho.hit does, with the index of the hit record in place of SBT offset and stride."),
    execute(),
    object("ho.value", HitObjectOp::Value, {Dst32, Src32, Src32},
           "Returns a value of an object (object, number of the value in isa/hit_object.h)."),
    object("ho.attributes", HitObjectOp::Attributes, {Src32, Src32},
           "Stores the 64 bytes of an object's attributes (object, local address)."),
    object("rt.time.set", HitObjectOp::SetTime, {Src32},
           "Sets the time of the next ray or made hit, which is 0 otherwise."),
    object("rt.time.get", HitObjectOp::GetTime, {Dst32}, "Returns the time of the innermost trace's ray."),
    object(
        "rt.corner", HitObjectOp::Corner, {Dst32, Src32},
        "Returns a coordinate of a corner of the triangle whose hit shader runs, in object space: 0 to 2 are "
        "x, y, z of the first corner, and the others follow."),
    reorder("ho.reorder", HitObjectOp::Reorder, {Src32, Src32, Src32, Src32},
            "Says that a core may regroup lanes here by what an object holds and a hint (object, hint, its "
            "number of bits, number of live registers)."),
    reorder("ho.reorder.hint", HitObjectOp::ReorderByHint, {Src32, Src32, Src32},
            "Says that a core may regroup lanes here by a hint (hint, its number of bits, number of live "
            "registers)."),
    reorder("rt.reorder", HitObjectOp::ReorderByTrace, {},
            "Says that a core may regroup lanes here by the records that the rays of the innermost trace "
            "have hit."),
};

}  // namespace

RowList hit_object_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
