// Defines ops that steer a warp: branches, regions whose lanes meet again, and ends.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow control(std::string_view name, Effect effect, Operands operands, std::string_view doc) {
  return effect_op(name, Class::Ctrl, Unit::Branch, effect, operands, doc);
}

constexpr OpRow kRows[] = {
    control("bra", Effect::Branch, {Label}, "Continues at the label. A guard may split the warp."),
    control("ssy", Effect::PushReconvergence, {Label},
            "Opens a region whose lanes meet at the join of the label."),
    control("join", Effect::Join, {}, "Waits until every lane of the region has arrived or left it."),
    control(
        "brx.idx", Effect::BranchIndexed, {Src32, Label},
        "Continues at that branch, counted from 0, in the table of bra at the label. It may split the warp."),
    control("call", Effect::Call, {Label}, "Calls the function at the label, whose ret comes back here."),
    control("call.function", Effect::CallFunction, {Src32},
            "Calls the function with that number, whose ret comes back here. Lanes with one number run "
            "together."),
    control("exit", Effect::Exit, {}, "Ends the lanes."),
    control("ret", Effect::Return, {},
            "Returns from the function or shader. An any-hit shader accepts its candidate."),
    control("yield", Effect::Yield, {},
            "Says that lanes may go round here until others of their warp have done something."),
    control("trap", Effect::Trap, {}, "Stops the run with a fault."),
};

}  // namespace

RowList control_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
