// Lowers GLSL.std.450: each function becomes the sequence of ISA ops that computes it. Sums of products are
// chains of fma, as GPUs compute them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <spirv/unified1/GLSL.std.450.h>
#include <string_view>
#include <utility>

#include "frontend/lower/lowering.h"
#include "frontend/lower/math.h"
#include "frontend/lower/pack.h"
#include "frontend/spirv/spirv.h"

namespace glint::frontend {
namespace {

using Arguments = std::vector<Operands>;
using Scalars = std::vector<Operand>;

// Holds a function that works part by part. `compute` gets one scalar of each argument; a scalar argument
// repeats. Half precision is computed in single precision and rounded. Narrow integers are widened, with
// their sign if `name` says s32.
struct Componentwise {
  uint32_t function;
  Operand (*compute)(Arithmetic&, const Scalars&, std::string_view name);
  std::string_view name;
  bool only_32_bits = false;
};

Operand op(Arithmetic& a, const Scalars& x, std::string_view name) {
  return a.op(name, x);
}

// Returns min(max(x, low), high). Choice: the same formula holds where low > high.
Operand clamp_f32(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.min(a.max(x[0], x[1]), x[2]);
}
Operand clamp_s32(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.op("min.s32", {a.op("max.s32", {x[0], x[1]}), x[2]});
}
Operand clamp_u32(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.op("min.u32", {a.op("max.u32", {x[0], x[1]}), x[2]});
}
// Returns x + a (y - x), rounded twice, which gives a driver's bits (tests/shaders). Choice: Vulkan defines
// x (1 - a) + y a, and its conformance tests take both. Of the forms with two or three ops, this one has the
// smallest error where the sum cancels, but mix(x, y, 1) is y only where y - x is exact.
Operand mix(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.fma(x[2], a.sub(x[1], x[0]), x[0]);
}
Operand inverse_sqrt(Arithmetic& a, const Scalars& x, std::string_view) {
  if (!a.is_double()) return a.op("rsqrt.f32", x);
  return a.div(a.constant(1), a.sqrt(x[0]));
}
Operand radians(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.mul(x[0], a.constant(0.017453292519943295));
}
Operand degrees(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.mul(x[0], a.constant(57.29577951308232));
}
Operand fract(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.sub(x[0], a.op("cvt.rmi.f32.f32", {x[0]}));
}
Operand tangent(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.div(a.op("sin.f32", {x[0]}), a.op("cos.f32", {x[0]}));
}
Operand sign_f32(Arithmetic& a, const Scalars& x, std::string_view) {
  const Operand zero = a.constant(0);
  return a.select(a.greater(x[0], zero), a.constant(1), a.select(a.less(x[0], zero), a.constant(-1), zero));
}
Operand sign_s32(Arithmetic& a, const Scalars& x, std::string_view) {
  const Operand minus_one = Operand::value(a.is_double() ? ~0ull : 0xffff'ffff);
  return a.op("min.s32", {a.op("max.s32", {x[0], minus_one}), Operand::value(1)});
}
Operand step(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.select(a.less(x[1], x[0]), a.constant(0), a.constant(1));
}
Operand smooth_step(Arithmetic& a, const Scalars& x, std::string_view) {
  const Operand ratio = a.div(a.sub(x[2], x[0]), a.sub(x[1], x[0]));
  const Operand t = clamp_f32(a, {ratio, a.constant(0), a.constant(1)}, {});
  return a.mul(a.mul(t, t), a.sub(a.constant(3), a.mul(a.constant(2), t)));
}
// Returns the number of the lowest set bit, which x & -x isolates; 0 gives -1.
Operand find_lsb(Arithmetic& a, const Scalars& x, std::string_view) {
  return a.op("bfind.u32", {a.op("and.b32", {x[0], a.op("neg.s32", {x[0]})})});
}
Operand load_exponent(Arithmetic& a, const Scalars& x, std::string_view) {
  return math::ldexp(a, x[0], x[1]);
}
template <Operand (*kFunction)(Emitter&, Operand)>
Operand single(Arithmetic& a, const Scalars& x, std::string_view) {
  return kFunction(a.emit(), x[0]);
}
template <Operand (*kFunction)(Emitter&, Operand, Operand)>
Operand single2(Arithmetic& a, const Scalars& x, std::string_view) {
  return kFunction(a.emit(), x[0], x[1]);
}

constexpr Componentwise kComponentwise[] = {
    {GLSLstd450Round, op, "cvt.rni.f32.f32"},
    {GLSLstd450RoundEven, op, "cvt.rni.f32.f32"},
    {GLSLstd450Trunc, op, "cvt.rzi.f32.f32"},
    {GLSLstd450Floor, op, "cvt.rmi.f32.f32"},
    {GLSLstd450Ceil, op, "cvt.rpi.f32.f32"},
    {GLSLstd450Fract, fract, ""},
    {GLSLstd450FAbs, op, "abs.f32"},
    {GLSLstd450SAbs, op, "abs.s32"},
    {GLSLstd450FSign, sign_f32, ""},
    {GLSLstd450SSign, sign_s32, "min.s32"},
    {GLSLstd450Radians, radians, ""},
    {GLSLstd450Degrees, degrees, ""},
    {GLSLstd450Sin, op, "sin.f32", true},
    {GLSLstd450Cos, op, "cos.f32", true},
    {GLSLstd450Tan, tangent, "", true},
    {GLSLstd450Asin, single<math::asin>, "", true},
    {GLSLstd450Acos, single<math::acos>, "", true},
    {GLSLstd450Atan, single<math::atan>, "", true},
    {GLSLstd450Atan2, single2<math::atan2>, "", true},
    {GLSLstd450Sinh, single<math::sinh>, "", true},
    {GLSLstd450Cosh, single<math::cosh>, "", true},
    {GLSLstd450Tanh, single<math::tanh>, "", true},
    {GLSLstd450Asinh, single<math::asinh>, "", true},
    {GLSLstd450Acosh, single<math::acosh>, "", true},
    {GLSLstd450Atanh, single<math::atanh>, "", true},
    {GLSLstd450Pow, single2<math::pow>, "", true},
    {GLSLstd450Exp, single<math::exp>, "", true},
    {GLSLstd450Log, single<math::log>, "", true},
    {GLSLstd450Exp2, op, "ex2.f32", true},
    {GLSLstd450Log2, op, "lg2.f32", true},
    {GLSLstd450Sqrt, op, "sqrt.rn.f32"},
    {GLSLstd450InverseSqrt, inverse_sqrt, ""},
    {GLSLstd450FMin, op, "min.f32"},
    {GLSLstd450UMin, op, "min.u32"},
    {GLSLstd450SMin, op, "min.s32"},
    {GLSLstd450FMax, op, "max.f32"},
    {GLSLstd450UMax, op, "max.u32"},
    {GLSLstd450SMax, op, "max.s32"},
    {GLSLstd450FClamp, clamp_f32, ""},
    {GLSLstd450UClamp, clamp_u32, ""},
    {GLSLstd450SClamp, clamp_s32, "min.s32"},
    {GLSLstd450FMix, mix, ""},
    {GLSLstd450Step, step, ""},
    {GLSLstd450SmoothStep, smooth_step, ""},
    {GLSLstd450Fma, op, "fma.rn.f32"},
    {GLSLstd450Ldexp, load_exponent, ""},
    {GLSLstd450FindILsb, find_lsb, "", true},
    {GLSLstd450FindSMsb, op, "bfind.s32", true},
    {GLSLstd450FindUMsb, op, "bfind.u32", true},
    {GLSLstd450NMin, op, "min.f32"},
    {GLSLstd450NMax, op, "max.f32"},
    {GLSLstd450NClamp, clamp_f32, ""},
};

// These functions work on whole vectors.
Operands length(Arithmetic& a, const Arguments& x) {
  if (x[0].size() == 1) return {a.magnitude(x[0][0])};
  return {a.sqrt(math::dot(a, x[0], x[0]))};
}
Operands distance(Arithmetic& a, const Arguments& x) {
  Operands difference;
  for (size_t i = 0; i < x[0].size(); ++i) difference.push_back(a.sub(x[0][i], x[1][i]));
  return length(a, {difference});
}
// Uses a correctly rounded square root and division, and not the 2-ulp reciprocal root of hardware.
Operands normalize(Arithmetic& a, const Arguments& x) {
  const Operand norm = length(a, x)[0];
  Operands result;
  for (const Operand& part : x[0]) result.push_back(a.div(part, norm));
  return result;
}
// Rounds only the second product of each difference. So a vector's product with itself is not always 0.
Operands cross(Arithmetic& a, const Arguments& x) {
  const auto term = [&](int i, int j) {
    return a.fma(x[0][i], x[1][j], a.negative(a.mul(x[1][i], x[0][j])));
  };
  return {term(1, 2), term(2, 0), term(0, 1)};
}
// Returns I - 2 * dot(N, I) * N.
Operands reflect(Arithmetic& a, const Arguments& x) {
  const Operand minus_twice = a.mul(a.constant(-2), math::dot(a, x[1], x[0]));
  Operands result;
  for (size_t i = 0; i < x[0].size(); ++i) result.push_back(a.fma(minus_twice, x[1][i], x[0][i]));
  return result;
}
// With k = 1 - eta^2 (1 - dot(N, I)^2), returns 0 for k < 0, else eta * I - (eta * dot(N, I) + sqrt(k)) * N.
Operands refract(Arithmetic& a, const Arguments& x) {
  const Operand eta = x[2][0], one = a.constant(1);
  const Operand d = math::dot(a, x[1], x[0]);
  const Operand k = a.fma(a.negative(a.mul(eta, eta)), a.fma(a.negative(d), d, one), one);
  const Operand total_reflection = a.less(k, a.constant(0));
  const Operand against = a.negative(a.fma(eta, d, a.sqrt(k)));
  Operands result;
  for (size_t i = 0; i < x[0].size(); ++i)
    result.push_back(a.select(total_reflection, a.constant(0), a.fma(against, x[1][i], a.mul(eta, x[0][i]))));
  return result;
}
// Returns N if dot(Nref, I) < 0, and -N otherwise.
Operands face_forward(Arithmetic& a, const Arguments& x) {
  const Operand keep = a.less(math::dot(a, x[2], x[1]), a.constant(0));
  Operands result;
  for (const Operand& part : x[0]) result.push_back(a.select(keep, part, a.negative(part)));
  return result;
}
// Returns the struct {fraction, exponent} or {fraction, whole}: all parts of the first member, then those of
// the second.
template <math::Split (*kFunction)(Arithmetic&, Operand)>
Operands split(Arithmetic& a, const Arguments& x) {
  Operands first, second;
  for (const Operand& part : x[0]) {
    const math::Split both = kFunction(a, part);
    first.push_back(both.fraction);
    second.push_back(both.exponent);
  }
  first.insert(first.end(), second.begin(), second.end());
  return first;
}
Operands pack_double(Arithmetic& a, const Arguments& x) {
  return {a.emit().value("pack.b64", {x[0][0], x[0][1]})};
}
Operands unpack_double(Arithmetic& a, const Arguments& x) {
  const Operand high = a.op("shr.u32", {x[0][0], Operand::value(32)});
  return {a.emit().value("cvt.u32.u64", {x[0][0]}), a.emit().value("cvt.u32.u64", {high})};
}
template <Operands (*kFunction)(Emitter&, const Arguments&)>
Operands packing(Arithmetic& a, const Arguments& x) {
  return kFunction(a.emit(), x);
}

struct Whole {
  uint32_t function;
  Operands (*compute)(Arithmetic&, const Arguments&);
};
constexpr Whole kWhole[] = {
    {GLSLstd450Length, length},
    {GLSLstd450Distance, distance},
    {GLSLstd450Normalize, normalize},
    {GLSLstd450Cross, cross},
    {GLSLstd450Reflect, reflect},
    {GLSLstd450Refract, refract},
    {GLSLstd450FaceForward, face_forward},
    {GLSLstd450Determinant, math::determinant},
    {GLSLstd450MatrixInverse, math::inverse},
    {GLSLstd450FrexpStruct, split<math::frexp>},
    {GLSLstd450ModfStruct, split<math::modf>},
    {GLSLstd450PackDouble2x32, pack_double},
    {GLSLstd450UnpackDouble2x32, unpack_double},
    {GLSLstd450PackUnorm4x8, packing<pack::pack_unorm_4x8>},
    {GLSLstd450PackSnorm4x8, packing<pack::pack_snorm_4x8>},
    {GLSLstd450PackUnorm2x16, packing<pack::pack_unorm_2x16>},
    {GLSLstd450PackSnorm2x16, packing<pack::pack_snorm_2x16>},
    {GLSLstd450PackHalf2x16, packing<pack::pack_half_2x16>},
    {GLSLstd450UnpackUnorm4x8, packing<pack::unpack_unorm_4x8>},
    {GLSLstd450UnpackSnorm4x8, packing<pack::unpack_snorm_4x8>},
    {GLSLstd450UnpackUnorm2x16, packing<pack::unpack_unorm_2x16>},
    {GLSLstd450UnpackSnorm2x16, packing<pack::unpack_snorm_2x16>},
    {GLSLstd450UnpackHalf2x16, packing<pack::unpack_half_2x16>},
};

const Componentwise* find_componentwise(uint32_t function) {
  const auto row = std::find_if(std::begin(kComponentwise), std::end(kComponentwise),
                                [&](const Componentwise& c) { return c.function == function; });
  return row == std::end(kComponentwise) ? nullptr : row;
}
const Whole* find_whole(uint32_t function) {
  const auto row = std::find_if(std::begin(kWhole), std::end(kWhole),
                                [&](const Whole& w) { return w.function == function; });
  return row == std::end(kWhole) ? nullptr : row;
}

// Holds one call: its arguments, widened to 32 bits where they are narrower, and properties of the call.
struct Call {
  uint32_t function;
  Arguments arguments;
  bool is_wide = false;  // an argument or result has 64 bits
};

// Returns the exponent of Ldexp, which may be an integer of any width, as one of 32 bits. It is clamped to
// limits beyond which every exponent gives 0 or infinity.
Operand exponent(Emitter& e, Part part, const Operand& x) {
  if (bytes_of(part) < 8) return widened(e, part, x, true);
  constexpr int64_t kFar = 1 << 16;
  const Operand near = e.value(
      "min.s64", {e.value("max.s64", {x, Operand::value(uint64_t(-kFar))}), Operand::value(uint64_t(kFar))});
  return e.value("cvt.u32.u64", {near});
}

Call read_call(ModuleLowering& l, const Instruction& inst, size_t num_arguments, bool sign_extend) {
  Call call{inst.operands[1], {}, false};
  const auto note = [&](Id type) {
    const std::vector<Part>& parts = l.layout().parts(type);
    if (!parts.empty() && bytes_of(parts[0]) == 8) call.is_wide = true;
  };
  note(inst.type);
  for (size_t i = 0; i < num_arguments; ++i) {
    const Id argument = inst.operands[2 + i];
    const Id type = l.type_of(argument);
    const bool is_exponent = call.function == GLSLstd450Ldexp && i == 1;
    if (!is_exponent) note(type);
    Operands parts = l.value(argument);
    for (size_t part = 0; part < parts.size(); ++part) {
      const Part kind = l.layout().parts(type)[part];
      parts[part] = is_exponent ? exponent(l.emit(), kind, parts[part])
                                : widened(l.emit(), kind, parts[part], sign_extend);
    }
    call.arguments.push_back(std::move(parts));
  }
  return call;
}

Operands narrowed_parts(ModuleLowering& l, Id type, Operands parts) {
  for (size_t i = 0; i < parts.size(); ++i)
    parts[i] = narrowed(l.emit(), l.layout().parts(type)[i], parts[i]);
  return parts;
}

// Lowers Frexp and Modf, which store their second result through a pointer, their last argument.
void lower_with_pointer(ModuleLowering& l, const Instruction& inst) {
  const Call call = read_call(l, inst, 1, false);
  Arithmetic a(l.emit(), call.is_wide);
  const bool is_frexp = call.function == GLSLstd450Frexp;
  Operands parts = is_frexp ? split<math::frexp>(a, call.arguments) : split<math::modf>(a, call.arguments);
  const Pointer pointer = l.pointer(inst.operands[3]);
  const auto middle = parts.begin() + long(parts.size() / 2);
  l.store(pointer, narrowed_parts(l, pointer.type, Operands(middle, parts.end())));
  l.set(inst.result, narrowed_parts(l, inst.type, Operands(parts.begin(), middle)));
}

}  // namespace

void lower_glsl_std(ModuleLowering& l, const Instruction& inst) {
  const uint32_t function = inst.operands[1];
  const size_t num_arguments = inst.operands.size() - 2;
  if (function == GLSLstd450Frexp || function == GLSLstd450Modf) return lower_with_pointer(l, inst);
  if (const Componentwise* row = find_componentwise(function)) {
    const bool sign_extend = row->name.find("s32") != std::string_view::npos;
    const Call call = read_call(l, inst, num_arguments, sign_extend);
    if (call.is_wide && row->only_32_bits)
      return l.unsupported(fmt::format("{} of 64 bits", name_of_glsl_function(function)));
    Arithmetic a(l.emit(), call.is_wide);
    Operands result;
    for (size_t i = 0; i < l.layout().num_parts(inst.type); ++i) {
      Scalars scalars;
      for (const Operands& argument : call.arguments)
        scalars.push_back(argument[argument.size() == 1 ? 0 : i]);
      result.push_back(row->compute(a, scalars, row->name));
    }
    return l.set(inst.result, narrowed_parts(l, inst.type, std::move(result)));
  }
  if (const Whole* row = find_whole(function)) {
    const Call call = read_call(l, inst, num_arguments, false);
    Arithmetic a(l.emit(), call.is_wide);
    return l.set(inst.result, narrowed_parts(l, inst.type, row->compute(a, call.arguments)));
  }
  l.unsupported(name_of_glsl_function(function));
}

}  // namespace glint::frontend
