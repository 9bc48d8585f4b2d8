// Defines printing from a shader: the words of a message, which the machine formats (isa/message.h).
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Model: a print takes one issue slot. On hardware it takes a few dozen instructions that append to a buffer.
constexpr OpRow print(std::string_view name, Effect effect, std::string_view doc) {
  return effect_op(name, Class::Ctrl, Unit::Move, effect, {Src32, Src32, Src32, Src32, Src32}, doc);
}

constexpr OpRow kRows[] = {
    print("print", Effect::Print,
          "Prints a message with four words and ends the lane's line. The message's number is a constant."),
    print("print.part", Effect::PrintPart,
          "Prints as print does, but the lane's next message continues the line."),
};

}  // namespace

RowList print_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
