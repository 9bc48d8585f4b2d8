// Defines ops that give rays to the RT unit and run the shaders that it asks for (docs/abi.md, "Calls and
// rays").
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow ray(std::string_view name, Effect effect, Operands operands, std::string_view doc) {
  return effect_op(name, Class::Rt, Unit::RtUnit, effect, operands, doc);
}
// The branch unit executes indirect calls.
constexpr OpRow call(std::string_view name, Effect effect, std::string_view doc, Operands operands = {}) {
  return effect_op(name, Class::Ctrl, Unit::Branch, effect, operands, doc);
}

constexpr OpRow kRows[] = {
    ray("rt.trace", Effect::Trace,
        {DstPred, Src64, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32, Src32,
         Src32, Src32, Src32},
        "Traces a ray (waiting lanes, structure, flags, mask, SBT offset, SBT stride, miss index, origin, "
        "tmin, direction, tmax, payload, attributes)."),
    ray("rt.resume", Effect::Resume, {DstPred},
        "Hands decided candidates back to the RT unit, and tells which lanes wait again."),
    ray("rt.report", Effect::Report, {DstPred, Src32, Src32},
        "Reports a hit (t, kind) of an intersection shader, and tells which lanes need their any-hit "
        "shader."),
    ray("rt.accepted", Effect::Accepted, {DstPred}, "Tells which lanes' last reported hit was accepted."),
    ray("rt.ignore", Effect::Ignore, {}, "Rejects the candidate and ends the any-hit shader."),
    ray("rt.terminate", Effect::Terminate, {},
        "Accepts the candidate, ends the traversal and the any-hit shader."),
    ray("rt.end", Effect::EndTrace, {}, "Closes the innermost rt.trace."),
    call("call.sbt.candidate", Effect::CallCandidate,
         "Calls the intersection or any-hit shader of each lane's candidate, split by shader."),
    call("call.sbt.anyhit", Effect::CallAnyHit,
         "Calls the any-hit shader of each lane's reported hit, split by shader."),
    call("call.sbt.hit", Effect::CallHit,
         "Calls the closest-hit or miss shader of each lane's ray, split by shader."),
    call("call.sbt.callable", Effect::CallCallable,
         "Calls each lane's callable shader, split by shader (index of its record, local address of its "
         "data).",
         {Src32, Src32}),
};

}  // namespace

RowList ray_tracing_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
