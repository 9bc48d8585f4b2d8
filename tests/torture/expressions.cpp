// Picks ops from a table and operands of their sorts among the values before.
// SPDX-License-Identifier: Apache-2.0
#include "tests/torture/expressions.h"

#include <bit>
#include <fmt/format.h>
#include <spirv/unified1/GLSL.std.450.h>
#include <string_view>
#include <utility>

#include "frontend/spirv/spirv.h"
#include "tests/torture/spirv_writer.h"
#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

using enum spv::Op;

enum Type : uint8_t { U32, F32, Bool, U64, U16, U8, F64, kKinds };
constexpr uint32_t kWidth[kKinds] = {32, 32, 1, 64, 16, 8, 64};
bool is_float(Type kind) {
  return kind == F32 || kind == F64;
}

// Says how an op's operands and result are formed. Any takes operands as they are and gives their type. The
// count of a Shift is masked to the width, and the divisor of a Divide is made odd, so it is not 0. The other
// forms have operands or results of their own shape.
enum class Form : uint8_t {
  Any,
  Shift,
  Divide,
  Compare,
  Select,
  ByScalar,
  Dot,
  AnyAll,
  Extract,
  Insert,
  Pair,
  Convert,
  Shuffle,
  PickPart
};

struct OpRow {
  spv::Op op;
  uint32_t function;  // of GLSL.std.450, 0: none
  const char* kinds;  // of the first operand: u f b l(64) s(16) c(8) d
  int arguments;
  Form form = Form::Any;
};

constexpr OpRow kRows[] = {
    {OpIAdd, 0, "ulsc", 2},
    {OpISub, 0, "ulsc", 2},
    {OpIMul, 0, "ulsc", 2},
    {OpUDiv, 0, "ulsc", 2, Form::Divide},
    {OpSDiv, 0, "ulsc", 2, Form::Divide},
    {OpUMod, 0, "ulsc", 2, Form::Divide},
    {OpSRem, 0, "ulsc", 2, Form::Divide},
    {OpSMod, 0, "ulsc", 2, Form::Divide},
    {OpSNegate, 0, "ulsc", 1},
    {OpBitwiseAnd, 0, "ulsc", 2},
    {OpBitwiseOr, 0, "ulsc", 2},
    {OpBitwiseXor, 0, "ulsc", 2},
    {OpNot, 0, "ulsc", 1},
    {OpShiftLeftLogical, 0, "ulsc", 2, Form::Shift},
    {OpShiftRightLogical, 0, "ulsc", 2, Form::Shift},
    {OpShiftRightArithmetic, 0, "ulsc", 2, Form::Shift},
    {OpFAdd, 0, "fd", 2},
    {OpFSub, 0, "fd", 2},
    {OpFMul, 0, "fd", 2},
    {OpFDiv, 0, "fd", 2},
    {OpFNegate, 0, "fd", 1},
    {OpFMod, 0, "f", 2},
    {OpFRem, 0, "f", 2},
    {OpVectorTimesScalar, 0, "f", 2, Form::ByScalar},
    {OpDot, 0, "f", 2, Form::Dot},
    {OpIEqual, 0, "ulsc", 2, Form::Compare},
    {OpINotEqual, 0, "ulsc", 2, Form::Compare},
    {OpULessThan, 0, "ulsc", 2, Form::Compare},
    {OpULessThanEqual, 0, "ulsc", 2, Form::Compare},
    {OpUGreaterThan, 0, "ulsc", 2, Form::Compare},
    {OpUGreaterThanEqual, 0, "ulsc", 2, Form::Compare},
    {OpSLessThan, 0, "ulsc", 2, Form::Compare},
    {OpSLessThanEqual, 0, "ulsc", 2, Form::Compare},
    {OpSGreaterThan, 0, "ulsc", 2, Form::Compare},
    {OpSGreaterThanEqual, 0, "ulsc", 2, Form::Compare},
    {OpFOrdEqual, 0, "fd", 2, Form::Compare},
    {OpFOrdNotEqual, 0, "fd", 2, Form::Compare},
    {OpFOrdLessThan, 0, "fd", 2, Form::Compare},
    {OpFOrdLessThanEqual, 0, "fd", 2, Form::Compare},
    {OpFOrdGreaterThan, 0, "fd", 2, Form::Compare},
    {OpFOrdGreaterThanEqual, 0, "fd", 2, Form::Compare},
    {OpFUnordEqual, 0, "fd", 2, Form::Compare},
    {OpFUnordNotEqual, 0, "fd", 2, Form::Compare},
    {OpFUnordLessThan, 0, "fd", 2, Form::Compare},
    {OpFUnordLessThanEqual, 0, "fd", 2, Form::Compare},
    {OpFUnordGreaterThan, 0, "fd", 2, Form::Compare},
    {OpFUnordGreaterThanEqual, 0, "fd", 2, Form::Compare},
    {OpIsNan, 0, "fd", 1, Form::Compare},
    {OpIsInf, 0, "fd", 1, Form::Compare},
    {OpLogicalAnd, 0, "b", 2},
    {OpLogicalOr, 0, "b", 2},
    {OpLogicalEqual, 0, "b", 2},
    {OpLogicalNotEqual, 0, "b", 2},
    {OpLogicalNot, 0, "b", 1},
    {OpAny, 0, "b", 1, Form::AnyAll},
    {OpAll, 0, "b", 1, Form::AnyAll},
    {OpSelect, 0, "ufblscd", 2, Form::Select},
    {OpBitCount, 0, "u", 1},
    {OpBitReverse, 0, "u", 1},
    {OpBitFieldSExtract, 0, "u", 1, Form::Extract},
    {OpBitFieldUExtract, 0, "u", 1, Form::Extract},
    {OpBitFieldInsert, 0, "u", 2, Form::Insert},
    {OpIAddCarry, 0, "u", 2, Form::Pair},
    {OpISubBorrow, 0, "u", 2, Form::Pair},
    {OpUMulExtended, 0, "u", 2, Form::Pair},
    {OpSMulExtended, 0, "u", 2, Form::Pair},
    {OpConvertFToS, 0, "fd", 1, Form::Convert},
    {OpConvertFToU, 0, "fd", 1, Form::Convert},
    {OpConvertSToF, 0, "ulsc", 1, Form::Convert},
    {OpConvertUToF, 0, "ulsc", 1, Form::Convert},
    {OpUConvert, 0, "ulsc", 1, Form::Convert},
    {OpSConvert, 0, "ulsc", 1, Form::Convert},
    {OpFConvert, 0, "fd", 1, Form::Convert},
    {OpBitcast, 0, "ufld", 1, Form::Convert},
    {OpVectorShuffle, 0, "ufblscd", 2, Form::Shuffle},
    {OpCompositeExtract, 0, "ufblscd", 1, Form::PickPart},
    {OpExtInst, GLSLstd450Round, "f", 1},
    {OpExtInst, GLSLstd450RoundEven, "f", 1},
    {OpExtInst, GLSLstd450Trunc, "f", 1},
    {OpExtInst, GLSLstd450Floor, "f", 1},
    {OpExtInst, GLSLstd450Ceil, "f", 1},
    {OpExtInst, GLSLstd450Fract, "f", 1},
    {OpExtInst, GLSLstd450FAbs, "f", 1},
    {OpExtInst, GLSLstd450FSign, "f", 1},
    {OpExtInst, GLSLstd450Radians, "f", 1},
    {OpExtInst, GLSLstd450Degrees, "f", 1},
    {OpExtInst, GLSLstd450Sqrt, "f", 1},
    {OpExtInst, GLSLstd450FMin, "f", 2},
    {OpExtInst, GLSLstd450FMax, "f", 2},
    {OpExtInst, GLSLstd450FClamp, "f", 3},
    {OpExtInst, GLSLstd450FMix, "f", 3},
    {OpExtInst, GLSLstd450Step, "f", 2},
    {OpExtInst, GLSLstd450SmoothStep, "f", 3},
    {OpExtInst, GLSLstd450Fma, "f", 3},
    {OpExtInst, GLSLstd450NMin, "f", 2},
    {OpExtInst, GLSLstd450NMax, "f", 2},
    {OpExtInst, GLSLstd450NClamp, "f", 3},
    {OpExtInst, GLSLstd450SAbs, "ulsc", 1},
    {OpExtInst, GLSLstd450SSign, "ulsc", 1},
    {OpExtInst, GLSLstd450SMin, "ulsc", 2},
    {OpExtInst, GLSLstd450SMax, "ulsc", 2},
    {OpExtInst, GLSLstd450UMin, "ulsc", 2},
    {OpExtInst, GLSLstd450UMax, "ulsc", 2},
    {OpExtInst, GLSLstd450SClamp, "ulsc", 3},
    {OpExtInst, GLSLstd450UClamp, "ulsc", 3},
    {OpExtInst, GLSLstd450FindILsb, "u", 1},
    {OpExtInst, GLSLstd450FindSMsb, "u", 1},
    {OpExtInst, GLSLstd450FindUMsb, "u", 1},
};

Type kind_of(char letter) {
  return Type(std::string_view("ufblscd").find(letter));
}

struct Known {
  Type kind;
  uint32_t count;
  Id id;
  std::string name;
};

class Maker {
 public:
  explicit Maker(uint64_t seed) : random_(seed) {}
  ExpressionProgram run(uint32_t count);

 private:
  Id scalar_type(Type kind) {
    return kind == Bool     ? w_.bool_type()
           : is_float(kind) ? w_.float_type(kWidth[kind])
                            : w_.int_type(kWidth[kind]);
  }
  Id type(Type kind, uint32_t count) {
    return count == 1 ? scalar_type(kind) : w_.declare(OpTypeVector, {scalar_type(kind), count});
  }
  Id op(spv::Op what, Id result_type, Words operands) {
    const Id id = w_.new_id();
    operands.insert(operands.begin(), {result_type, id});
    append(body_, what, operands);
    return id;
  }
  Id constant(Type kind, uint64_t bits) {
    if (kind == Bool) return w_.truth(bits & 1);
    if (kWidth[kind] == 64)
      return w_.declare(OpConstant, {scalar_type(kind), uint32_t(bits), uint32_t(bits >> 32)}, true);
    return w_.declare(OpConstant, {scalar_type(kind), uint32_t(bits) & uint32_t((1ull << kWidth[kind]) - 1)},
                      true);
  }
  Id splat(Type kind, uint32_t count, uint64_t bits) {
    const Id part = constant(kind, bits);
    if (count == 1) return part;
    Words operands{type(kind, count)};
    operands.insert(operands.end(), count, part);
    return w_.declare(OpConstantComposite, operands, true);
  }
  Id load_word();
  Known fresh(Type kind, uint32_t count);
  Known operand(Type kind, uint32_t count);
  // Returns the bits of a float, with those of NaN set to 0, because Vulkan leaves open which NaN a result
  // is.
  Id bits_of(Type kind, uint32_t count, Id x) {
    const Type to = kind == F32 ? U32 : U64;
    const Id is_nan = op(OpIsNan, type(Bool, count), {x});
    return op(OpSelect, type(to, count), {is_nan, splat(to, count, 0), op(OpBitcast, type(to, count), {x})});
  }
  Id masked(Id x, uint32_t mask) { return op(OpBitwiseAnd, w_.int_type(), {x, w_.word(mask)}); }
  void keep(Known value, std::string what);
  void apply(const OpRow& row);
  void convert(const OpRow& row, const Known& a);
  void special_form(const OpRow& row, Type kind, uint32_t count, const Known& a, const Known& b);
  std::string title(const OpRow& row) const {
    return row.function ? frontend::name_of_glsl_function(row.function)
                        : frontend::name_of_opcode(uint32_t(row.op));
  }

  Random random_;
  SpirvWriter w_;
  Words body_;
  std::vector<Known> known_;
  ExpressionProgram program_;
  Id inputs_ = 0, lane_ = 0, results_ = 0, glsl_ = 0, first_result_ = 0;
};

Id Maker::load_word() {
  const Id index = masked(op(OpIAdd, w_.int_type(),
                             {op(OpIMul, w_.int_type(), {lane_, w_.word(1 + 2 * random_.below(64))}),
                              w_.word(random_.below(kExpressionInputs))}),
                          kExpressionInputs - 1);
  const Id pointer = op(OpAccessChain, w_.pointer_to(spv::StorageClass::StorageBuffer, w_.int_type()),
                        {inputs_, w_.word(0), index});
  return op(OpLoad, w_.int_type(), {pointer});
}

// Returns a value from the inputs.
Known Maker::fresh(Type kind, uint32_t count) {
  Words parts;
  for (uint32_t i = 0; i < count; ++i) {
    const Id word = load_word();
    Id wide = 0;
    if (kWidth[kind] == 64) {
      const Id high = op(OpUConvert, w_.int_type(64), {load_word()}),
               low = op(OpUConvert, w_.int_type(64), {word});
      wide = op(OpBitwiseOr, w_.int_type(64),
                {op(OpShiftLeftLogical, w_.int_type(64), {high, w_.word(32)}), low});
    }
    switch (kind) {
      case Bool:
        parts.push_back(op(OpINotEqual, w_.bool_type(), {masked(word, 1), w_.word(0)}));
        break;
      case F32:
        parts.push_back(op(OpBitcast, w_.float_type(), {word}));
        break;
      case U64:
        parts.push_back(wide);
        break;
      case F64:
        parts.push_back(op(OpFConvert, w_.float_type(64), {op(OpBitcast, w_.float_type(), {word})}));
        break;
      case U16:
      case U8:
        parts.push_back(op(OpUConvert, scalar_type(kind), {word}));
        break;
      default:
        parts.push_back(word);
        break;
    }
  }
  Known value{kind, count, parts[0], "input"};
  if (count > 1) value.id = op(OpCompositeConstruct, type(kind, count), parts);
  keep(value, "input");
  return known_.back();
}

Known Maker::operand(Type kind, uint32_t count) {
  if (random_.chance(15)) {
    static constexpr uint64_t kWords[] = {
        0, 1, 2, 4, 31, 0xffff'ffff'ffff'ffffull, 0x8000'0000'8000'0080ull, 0x7fff'ffff, 16, 3, 0x3f80'0000};
    static constexpr float kFloats[] = {0.0f, -0.0f, 1.0f, -1.0f, 2.0f, 0.5f, 1e30f, -3.25f};
    const float number = kFloats[random_.below(std::size(kFloats))];
    const uint64_t bits = kind == F32   ? std::bit_cast<uint32_t>(number)
                          : kind == F64 ? std::bit_cast<uint64_t>(double(number))
                                        : kWords[random_.below(std::size(kWords))];
    return {kind, count, splat(kind, count, bits), fmt::format("{:#x}", bits)};
  }
  std::vector<const Known*> fitting;
  for (const Known& value : known_)
    if (value.kind == kind && value.count == count) fitting.push_back(&value);
  if (fitting.empty() || random_.chance(20)) return fresh(kind, count);
  return *fitting[random_.below(uint32_t(fitting.size()))];
}

// Stores the value's parts as words.
void Maker::keep(Known value, std::string what) {
  const auto number = uint32_t(program_.values.size());
  value.name = fmt::format("v{}", number);
  program_.values.push_back(
      fmt::format("{} = {} of {} x {} bits", value.name, what, value.count, kWidth[value.kind]));
  known_.push_back(value);
  const auto put = [&](uint32_t at, Id word) {
    const Id index = op(OpIAdd, w_.int_type(), {first_result_, w_.word(number * kValueWords + at)});
    const Id pointer = op(OpAccessChain, w_.pointer_to(spv::StorageClass::StorageBuffer, w_.int_type()),
                          {results_, w_.word(0), index});
    append(body_, OpStore, {pointer, word});
  };
  for (uint32_t i = 0; i < value.count; ++i) {
    Id part = value.count == 1 ? value.id : op(OpCompositeExtract, scalar_type(value.kind), {value.id, i});
    if (value.kind == Bool) part = op(OpSelect, w_.int_type(), {part, w_.word(1), w_.word(0)});
    if (is_float(value.kind)) part = bits_of(value.kind, 1, part);
    if (value.kind == U16 || value.kind == U8) part = op(OpUConvert, w_.int_type(), {part});
    if (kWidth[value.kind] != 64) {
      put(i, part);
      continue;
    }
    put(2 * i, op(OpUConvert, w_.int_type(), {part}));
    put(2 * i + 1,
        op(OpUConvert, w_.int_type(), {op(OpShiftRightLogical, w_.int_type(64), {part, w_.word(32)})}));
  }
}

void Maker::convert(const OpRow& row, const Known& a) {
  static constexpr Type kIntegers[] = {U32, U64, U16, U8};
  Type to = U32;
  switch (row.op) {
    case OpConvertFToS:
    case OpConvertFToU:
      to = random_.chance(50) ? U32 : U64;
      break;
    case OpConvertSToF:
    case OpConvertUToF:
      to = random_.chance(60) ? F32 : F64;
      break;
    case OpFConvert:
      to = a.kind == F32 ? F64 : F32;
      break;
    case OpBitcast:
      to = a.kind == U32 ? F32 : a.kind == F32 ? U32 : a.kind == U64 ? F64 : U64;
      break;
    default:
      do to = kIntegers[random_.below(4)];
      while (to == a.kind);
      break;
  }
  const Id result = row.op == OpBitcast && is_float(a.kind) ? bits_of(a.kind, a.count, a.id)
                                                            : op(row.op, type(to, a.count), {a.id});
  keep({to, a.count, result, {}}, fmt::format("{}({})", title(row), a.name));
}

void Maker::special_form(const OpRow& row, Type kind, uint32_t count, const Known& a, const Known& b) {
  const std::string what = fmt::format("{}({}, {})", title(row), a.name, b.name);
  const Id same = type(kind, count);
  switch (row.form) {
    case Form::Shift:
      return keep(
          {kind,
           count,
           op(row.op, same, {a.id, op(OpBitwiseAnd, same, {b.id, splat(kind, count, kWidth[kind] - 1)})}),
           {}},
          what + ", count masked");
    case Form::Divide:
      return keep(
          {kind, count, op(row.op, same, {a.id, op(OpBitwiseOr, same, {b.id, splat(kind, count, 1)})}), {}},
          what + ", divisor | 1");
    case Form::Compare:
      return keep({Bool,
                   count,
                   op(row.op, type(Bool, count), row.arguments == 1 ? Words{a.id} : Words{a.id, b.id}),
                   {}},
                  what);
    case Form::Dot:
      return keep({kind, 1, op(row.op, type(kind, 1), {a.id, b.id}), {}}, what);
    case Form::AnyAll:
      return keep({Bool, 1, op(row.op, w_.bool_type(), {a.id}), {}}, what);
    case Form::ByScalar: {
      const Known factor = operand(kind, 1);
      return keep({kind, count, op(row.op, same, {a.id, factor.id}), {}},
                  fmt::format("{}({}, {})", title(row), a.name, factor.name));
    }
    case Form::Select: {
      const Known condition = operand(Bool, count);
      return keep({kind, count, op(row.op, same, {condition.id, a.id, b.id}), {}},
                  fmt::format("OpSelect({}, {}, {})", condition.name, a.name, b.name));
    }
    case Form::Extract:
    case Form::Insert: {
      const Known at = operand(U32, 1), size = operand(U32, 1);
      Words operands{a.id};
      if (row.form == Form::Insert) operands.push_back(b.id);
      operands.push_back(masked(at.id, 15));
      const Id bits = masked(size.id, random_.chance(50) ? 15 : 17);
      operands.push_back(bits);
      return keep({kind, count, op(row.op, same, operands), {}},
                  what + fmt::format(" at {} & 15, {} bits", at.name, size.name));
    }
    case Form::Pair: {
      const Id both = op(row.op, w_.declare(OpTypeStruct, {same, same}), {a.id, b.id});
      keep({kind, count, op(OpCompositeExtract, same, {both, 0}), {}}, what + ", first");
      return keep({kind, count, op(OpCompositeExtract, same, {both, 1}), {}}, what + ", second");
    }
    case Form::Shuffle: {
      Words operands{a.id, b.id};
      const uint32_t parts = 2 + random_.below(3);
      for (uint32_t i = 0; i < parts; ++i) operands.push_back(random_.below(2 * count));
      return keep({kind, parts, op(row.op, type(kind, parts), operands), {}}, what);
    }
    case Form::PickPart:
      return keep({kind, 1, op(row.op, type(kind, 1), {a.id, random_.below(count)}), {}}, what);
    default:
      return;
  }
}

void Maker::apply(const OpRow& row) {
  const std::string_view kinds = row.kinds;
  const Type kind = kind_of(kinds[random_.below(uint32_t(kinds.size()))]);
  const bool needs_vector = row.form == Form::ByScalar || row.form == Form::Dot || row.form == Form::AnyAll ||
                            row.form == Form::Shuffle || row.form == Form::PickPart;
  const uint32_t count = needs_vector ? 2 + random_.below(3) : random_.chance(50) ? 1 : 1 + random_.below(4);
  const Known a = operand(kind, count);
  if (row.form == Form::Convert) return convert(row, a);
  const Known b = operand(kind, count);
  if (row.form != Form::Any) return special_form(row, kind, count, a, b);
  const Known c = operand(kind, count);
  Words operands{a.id, b.id, c.id};
  operands.resize(size_t(row.arguments));
  if (row.function) operands.insert(operands.begin(), {glsl_, row.function});
  keep({kind, count, op(row.op, type(kind, count), operands), {}},
       fmt::format("{}({}, {}, {})", title(row), a.name, b.name, c.name));
}

ExpressionProgram Maker::run(uint32_t count) {
  glsl_ = w_.new_id();
  inputs_ = w_.buffer_of_words(kInputBinding);
  results_ = w_.buffer_of_words(kResultBinding);
  const Id vector = type(U32, 3), global_id = w_.input(spv::BuiltIn::GlobalInvocationId, vector);
  const Id function_type = w_.declare(OpTypeFunction, {w_.void_type()}), entry = w_.new_id();
  lane_ = op(OpCompositeExtract, w_.int_type(), {op(OpLoad, vector, {global_id}), 0});
  const Id words_a_lane = w_.new_id();  // known when all values are
  first_result_ = op(OpIMul, w_.int_type(), {lane_, words_a_lane});
  for (uint32_t i = 0; i < count; ++i) apply(kRows[random_.below(std::size(kRows))]);
  append(w_.code, OpFunction, {w_.void_type(), entry, 0, function_type});
  append(w_.code, OpLabel, {w_.new_id()});
  append(w_.code, OpReturn, {});
  w_.code.resize(w_.code.size() - 1);
  for (size_t at = 0; at < body_.size(); at += body_[at] >> 16)  // the stand-in's only use
    for (size_t i = at + 1; (body_[at] & 0xffff) == uint32_t(OpIMul) && i < at + (body_[at] >> 16); ++i)
      if (body_[i] == words_a_lane) body_[i] = w_.word(uint32_t(program_.values.size()) * kValueWords);
  w_.code.insert(w_.code.end(), body_.begin(), body_.end());
  append(w_.code, OpReturn, {});
  append(w_.code, OpFunctionEnd, {});
  using spv::Capability;
  program_.spirv = w_.assemble(
      entry, 32, glsl_,
      {Capability::Shader, Capability::Int64, Capability::Int16, Capability::Int8, Capability::Float64});
  return std::move(program_);
}

}  // namespace

ExpressionProgram random_expressions(uint64_t seed, uint32_t count) {
  return Maker(seed).run(count);
}

std::vector<uint32_t> expression_inputs(uint64_t seed) {
  static constexpr uint32_t kSpecial[] = {0,           1,           2,           31,          32,
                                          0x7fff'ffff, 0x8000'0000, 0xffff'ffff, 0x3f80'0000, 0xbf80'0000,
                                          0x7f80'0000, 0xff80'0000, 0x7fc0'0000, 1,           0x8000'0001,
                                          0x0080'0000, 0x7f7f'ffff, 0x4f00'0000, 0xcf00'0000, 0x4f80'0000,
                                          0x3f00'0000, 0x4020'0000, 0xff,        0x8000,      0x80};
  Random random(seed ^ 0xface);
  std::vector<uint32_t> words;
  for (uint32_t i = 0; i < kExpressionInputs; ++i) {
    const uint32_t small = std::bit_cast<uint32_t>(float(int(random.below(2000)) - 1000) / 8);
    words.push_back(random.chance(30)   ? kSpecial[random.below(std::size(kSpecial))]
                    : random.chance(50) ? small
                                        : uint32_t(random.bits()));
  }
  return words;
}

}  // namespace glint::test::torture
