// Lowers conversions between types of numbers, and of bits between shapes.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/lower/typed.h"

namespace glint::frontend {
namespace {

// Returns PTX's name for a type of 32 bits and more. Narrow integers are converted as 32-bit integers.
std::string type_name(Part part, bool is_signed) {
  const uint32_t bits = 8 * bytes_of(part);
  if (is_float(part)) return fmt::format("f{}", bits);
  return fmt::format("{}{}", is_signed ? 's' : 'u', bits < 32 ? 32 : bits);
}

void each_part(ModuleLowering& l, const Instruction& inst, auto&& convert) {
  const Part to = l.part_of(inst.type), from = l.part_of(l.type_of(inst.operands[0]));
  Operands result;
  for (const Operand& x : Operands(l.value(inst.operands[0])))
    result.push_back(convert(l.emit(), to, from, x));
  l.set(inst.result, std::move(result));
}

// Converts towards 0. Choice: as in PTX, a number out of range becomes the nearest integer of the type, and
// NaN becomes 0.
void float_to_integer(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const bool is_signed = inst.op == spv::Op::OpConvertFToS;
  each_part(l, inst, [&](Emitter& e, Part to, Part from, const Operand& x) {
    const std::string to_name = fmt::format("{}{}", is_signed ? 's' : 'u', 8 * bytes_of(to));
    return narrowed(e, to, e.value(fmt::format("cvt.rzi.{}.{}", to_name, type_name(from, true)), {x}));
  });
}

void integer_to_float(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const bool is_signed = inst.op == spv::Op::OpConvertSToF;
  each_part(l, inst, [&](Emitter& e, Part to, Part from, const Operand& x) {
    return e.value(fmt::format("cvt.rn.{}.{}", type_name(to, true), type_name(from, is_signed)),
                   {widened(e, from, x, is_signed)});
  });
}

void float_to_float(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  each_part(l, inst, [](Emitter& e, Part to, Part from, const Operand& x) {
    if (to == from) return x;
    const std::string_view rounding = bytes_of(to) < bytes_of(from) ? "rn." : "";
    return e.value(fmt::format("cvt.{}{}.{}", rounding, type_name(to, true), type_name(from, true)), {x});
  });
}

// Converts to half precision and back. Choice: subnormal halves are kept, although they may become 0.
void quantize(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  each_part(l, inst, [](Emitter& e, Part, Part, const Operand& x) {
    return e.value("cvt.f32.f16", {e.value("cvt.rn.f16.f32", {x})});
  });
}

// Lowers UConvert and SConvert, which extend with zeros or with the sign, or cut off high bits.
void change_width(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const bool is_signed = inst.op == spv::Op::OpSConvert;
  each_part(l, inst, [&](Emitter& e, Part to, Part from, const Operand& x) {
    const bool to_wide = bytes_of(to) == 8, from_wide = bytes_of(from) == 8;
    if (to_wide && from_wide) return x;
    const Operand word = from_wide ? e.value("cvt.u32.u64", {x}) : widened(e, from, x, is_signed);
    if (to_wide) return e.value(is_signed ? "cvt.s64.s32" : "cvt.u64.u32", {word});
    return bytes_of(to) < bytes_of(from) || is_signed ? narrowed(e, to, word) : word;
  });
}

// Returns the parts as 32-bit words, with the first part in the lowest bits. Narrow parts that do not fill a
// word stay as they are.
Operands words_of(Emitter& e, Part part, const Operands& parts) {
  Operands words;
  const size_t bytes = bytes_of(part);
  if (bytes == 8) {
    for (const Operand& wide : parts) {
      words.push_back(e.value("cvt.u32.u64", {wide}));
      words.push_back(e.value("cvt.u32.u64", {e.value("shr.u64", {wide, Operand::value(32)})}));
    }
    return words;
  }
  const size_t per_word = 4 / bytes;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i % per_word == 0)
      words.push_back(parts[i]);
    else
      words.back() =
          e.value("or.b32",
                  {words.back(), e.value("shl.b32", {parts[i], Operand::value(8 * bytes * (i % per_word))})});
  }
  return words;
}

Operands parts_of(Emitter& e, Part part, const Operands& words, size_t count) {
  Operands parts;
  const size_t bytes = bytes_of(part);
  for (size_t i = 0; i < count; ++i) {
    if (bytes == 8) {
      parts.push_back(e.value("pack.b64", {words.at(2 * i), words.at(2 * i + 1)}));
    } else if (bytes == 4) {
      parts.push_back(words.at(i));
    } else {
      const size_t per_word = 4 / bytes;
      const Operand at = Operand::value(8 * bytes * (i % per_word)), width = Operand::value(8 * bytes);
      parts.push_back(e.value("bfe.u32", {words.at(i / per_word), at, width}));
    }
  }
  return parts;
}

void bitcast(ModuleLowering& l, const Instruction& inst, const LoweringRow&) {
  const Operands from = l.value(inst.operands[0]);
  const Part part = l.part_of(l.type_of(inst.operands[0])), to = l.part_of(inst.type);
  if (bytes_of(part) == bytes_of(to)) return l.set(inst.result, from);
  l.set(inst.result, parts_of(l.emit(), to, words_of(l.emit(), part, from), l.layout().num_parts(inst.type)));
}

using enum spv::Op;
constexpr LoweringRow kConvertRows[] = {
    {OpConvertFToS, float_to_integer, ""},
    {OpConvertFToU, float_to_integer, ""},
    {OpConvertSToF, integer_to_float, ""},
    {OpConvertUToF, integer_to_float, ""},
    {OpFConvert, float_to_float, ""},
    {OpQuantizeToF16, quantize, ""},
    {OpUConvert, change_width, ""},
    {OpSConvert, change_width, ""},
    {OpBitcast, bitcast, ""},
    {OpConvertUToPtr, bitcast, ""},
    {OpConvertPtrToU, bitcast, ""},
};

}  // namespace

std::span<const LoweringRow> conversion_rows() {
  return kConvertRows;
}

}  // namespace glint::frontend
