// GLSL.std.450: each function as the sequence of ISA ops that computes it; IEEE order, no contraction.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spirv/unified1/GLSL.std.450.h>

#include "frontend/lower.h"
#include "frontend/lower_math.h"
#include "frontend/lower_pack.h"
#include "frontend/spirv.h"

namespace glint::frontend {
namespace {

using Arguments = std::vector<Operands>;
using Scalars = std::vector<Operand>;

// Functions that work part by part: `compute` gets one scalar of each argument (a scalar argument repeats).
struct Componentwise {
  uint32_t function;
  Operand (*compute)(Emitter&, const Scalars&, std::string_view name);
  std::string_view name;
};

Operand op(Emitter& e, const Scalars& x, std::string_view name) {
  return e.value(name, x);
}

// min(max(x, low), high), also where low > high (Choice).
Operand clamp_f32(Emitter& e, const Scalars& x, std::string_view) {
  return e.value("min.f32", {e.value("max.f32", {x[0], x[1]}), x[2]});
}
Operand clamp_s32(Emitter& e, const Scalars& x, std::string_view) {
  return e.value("min.s32", {e.value("max.s32", {x[0], x[1]}), x[2]});
}
Operand clamp_u32(Emitter& e, const Scalars& x, std::string_view) {
  return e.value("min.u32", {e.value("max.u32", {x[0], x[1]}), x[2]});
}
Operand mix(Emitter& e, const Scalars& x, std::string_view) {
  return e.add(e.mul(x[0], e.sub(constant_f32(1), x[2])), e.mul(x[1], x[2]));
}
Operand inverse_sqrt(Emitter& e, const Scalars& x, std::string_view) {
  return e.div(constant_f32(1), e.value("sqrt.rn.f32", {x[0]}));
}
Operand scaled(Emitter& e, const Scalars& x, float factor) {
  return e.mul(x[0], constant_f32(factor));
}
Operand radians(Emitter& e, const Scalars& x, std::string_view) {
  return scaled(e, x, 0.017453292519943295f);
}
Operand degrees(Emitter& e, const Scalars& x, std::string_view) {
  return scaled(e, x, 57.29577951308232f);
}
Operand fract(Emitter& e, const Scalars& x, std::string_view) {
  return e.sub(x[0], e.value("cvt.rmi.f32.f32", {x[0]}));
}
Operand tangent(Emitter& e, const Scalars& x, std::string_view) {
  return e.div(e.value("sin.f32", {x[0]}), e.value("cos.f32", {x[0]}));
}
Operand sign_f32(Emitter& e, const Scalars& x, std::string_view) {
  const Operand negative = e.value("setp.lt.f32", {x[0], constant_f32(0)}),
                positive = e.value("setp.gt.f32", {x[0], constant_f32(0)});
  return e.select(positive, constant_f32(1), e.select(negative, constant_f32(-1), constant_f32(0)));
}
Operand sign_s32(Emitter& e, const Scalars& x, std::string_view) {
  return e.value("min.s32", {e.value("max.s32", {x[0], Operand::value(0xffff'ffff)}), Operand::value(1)});
}
Operand step(Emitter& e, const Scalars& x, std::string_view) {
  return e.select(e.value("setp.lt.f32", {x[1], x[0]}), constant_f32(0), constant_f32(1));
}
Operand smooth_step(Emitter& e, const Scalars& x, std::string_view) {
  const Operand ratio = e.div(e.sub(x[2], x[0]), e.sub(x[1], x[0]));
  const Operand t = clamp_f32(e, {ratio, constant_f32(0), constant_f32(1)}, {});
  return e.mul(e.mul(t, t), e.sub(constant_f32(3), e.mul(constant_f32(2), t)));
}
Operand find_lsb(Emitter& e, const Scalars& x,
                 std::string_view) {  // x & -x keeps the lowest bit; of 0 gives -1
  return e.value("bfind.u32", {e.value("and.b32", {x[0], e.value("neg.s32", {x[0]})})});
}
Operand of_math(Emitter& e, const Scalars& x, Operand (*f)(Emitter&, Operand)) {
  return f(e, x[0]);
}
Operand asine(Emitter& e, const Scalars& x, std::string_view) {
  return of_math(e, x, math::asin);
}
Operand acosine(Emitter& e, const Scalars& x, std::string_view) {
  return of_math(e, x, math::acos);
}
Operand atangent(Emitter& e, const Scalars& x, std::string_view) {
  return of_math(e, x, math::atan);
}
Operand atangent2(Emitter& e, const Scalars& x, std::string_view) {
  return math::atan2(e, x[0], x[1]);
}
Operand exponential(Emitter& e, const Scalars& x, std::string_view) {
  return math::exp(e, x[0]);
}
Operand logarithm(Emitter& e, const Scalars& x, std::string_view) {
  return math::log(e, x[0]);
}
Operand power(Emitter& e, const Scalars& x, std::string_view) {
  return math::pow(e, x[0], x[1]);
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
    {GLSLstd450SSign, sign_s32, ""},
    {GLSLstd450Radians, radians, ""},
    {GLSLstd450Degrees, degrees, ""},
    {GLSLstd450Sin, op, "sin.f32"},
    {GLSLstd450Cos, op, "cos.f32"},
    {GLSLstd450Tan, tangent, ""},
    {GLSLstd450Asin, asine, ""},
    {GLSLstd450Acos, acosine, ""},
    {GLSLstd450Atan, atangent, ""},
    {GLSLstd450Atan2, atangent2, ""},
    {GLSLstd450Pow, power, ""},
    {GLSLstd450Exp, exponential, ""},
    {GLSLstd450Log, logarithm, ""},
    {GLSLstd450Exp2, op, "ex2.f32"},
    {GLSLstd450Log2, op, "lg2.f32"},
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
    {GLSLstd450SClamp, clamp_s32, ""},
    {GLSLstd450FMix, mix, ""},
    {GLSLstd450Step, step, ""},
    {GLSLstd450SmoothStep, smooth_step, ""},
    {GLSLstd450Fma, op, "fma.rn.f32"},
    {GLSLstd450FindILsb, find_lsb, ""},
    {GLSLstd450FindSMsb, op, "bfind.s32"},
    {GLSLstd450FindUMsb, op, "bfind.u32"},
    {GLSLstd450NMin, op, "min.f32"},
    {GLSLstd450NMax, op, "max.f32"},
    {GLSLstd450NClamp, clamp_f32, ""},
};

// Functions over whole vectors.
Operands length(Emitter& e, const Arguments& x) {
  if (x[0].size() == 1) return {e.value("abs.f32", {x[0][0]})};
  return {e.value("sqrt.rn.f32", {math::dot(e, x[0], x[0])})};
}
Operands distance(Emitter& e, const Arguments& x) {
  Operands difference;
  for (size_t i = 0; i < x[0].size(); ++i) difference.push_back(e.sub(x[0][i], x[1][i]));
  return length(e, {difference});
}
// Correctly rounded square root and division, not the 2-ulp reciprocal root of hardware.
Operands normalize(Emitter& e, const Arguments& x) {
  const Operand norm = length(e, x)[0];
  Operands result;
  for (const Operand& part : x[0]) result.push_back(e.div(part, norm));
  return result;
}
Operands cross(Emitter& e, const Arguments& x) {
  const auto term = [&](int i, int j) { return e.sub(e.mul(x[0][i], x[1][j]), e.mul(x[1][i], x[0][j])); };
  return {term(1, 2), term(2, 0), term(0, 1)};
}
// I - 2 * dot(N, I) * N
Operands reflect(Emitter& e, const Arguments& x) {
  const Operand twice = e.mul(constant_f32(2), math::dot(e, x[1], x[0]));
  Operands result;
  for (size_t i = 0; i < x[0].size(); ++i) result.push_back(e.sub(x[0][i], e.mul(twice, x[1][i])));
  return result;
}
// k = 1 - eta^2 (1 - dot(N, I)^2); k < 0: 0, else eta * I - (eta * dot(N, I) + sqrt(k)) * N
Operands refract(Emitter& e, const Arguments& x) {
  const Operand eta = x[2][0], one = constant_f32(1);
  const Operand d = math::dot(e, x[1], x[0]);
  const Operand k = e.sub(one, e.mul(e.mul(eta, eta), e.sub(one, e.mul(d, d))));
  const Operand total_reflection = e.value("setp.lt.f32", {k, constant_f32(0)});
  const Operand along = e.add(e.mul(eta, d), e.value("sqrt.rn.f32", {k}));
  Operands result;
  for (size_t i = 0; i < x[0].size(); ++i)
    result.push_back(
        e.select(total_reflection, constant_f32(0), e.sub(e.mul(eta, x[0][i]), e.mul(along, x[1][i]))));
  return result;
}
// dot(Nref, I) < 0: N, else -N
Operands face_forward(Emitter& e, const Arguments& x) {
  const Operand keep = e.value("setp.lt.f32", {math::dot(e, x[2], x[1]), constant_f32(0)});
  Operands result;
  for (const Operand& part : x[0]) result.push_back(e.select(keep, part, e.value("neg.f32", {part})));
  return result;
}

struct Whole {
  uint32_t function;
  Operands (*compute)(Emitter&, const Arguments&);
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
    {GLSLstd450PackUnorm4x8, pack::pack_unorm_4x8},
    {GLSLstd450PackSnorm4x8, pack::pack_snorm_4x8},
    {GLSLstd450PackUnorm2x16, pack::pack_unorm_2x16},
    {GLSLstd450PackSnorm2x16, pack::pack_snorm_2x16},
    {GLSLstd450PackHalf2x16, pack::pack_half_2x16},
    {GLSLstd450UnpackUnorm4x8, pack::unpack_unorm_4x8},
    {GLSLstd450UnpackSnorm4x8, pack::unpack_snorm_4x8},
    {GLSLstd450UnpackUnorm2x16, pack::unpack_unorm_2x16},
    {GLSLstd450UnpackSnorm2x16, pack::unpack_snorm_2x16},
    {GLSLstd450UnpackHalf2x16, pack::unpack_half_2x16},
};

}  // namespace

void lower_glsl_std(Lowering& l, const Instruction& inst) {
  const uint32_t function = inst.operands[1];
  Arguments arguments;
  const auto read_arguments = [&] {
    for (size_t i = 2; i < inst.operands.size(); ++i) {
      arguments.push_back(l.value(inst.operands[i]));
      const std::vector<Part>& parts = l.layout().parts(l.type_of(inst.operands[i]));
      if (!parts.empty() && class_of(parts[0]) == RegisterClass::B64)
        l.unsupported(fmt::format("{} of 64 bits", name_of_glsl_function(function)));
    }
  };
  for (const Componentwise& row : kComponentwise) {
    if (row.function != function) continue;
    read_arguments();
    Operands result;
    for (size_t i = 0; i < l.layout().num_parts(inst.type); ++i) {
      Scalars scalars;
      for (const Operands& argument : arguments) scalars.push_back(argument[argument.size() == 1 ? 0 : i]);
      result.push_back(row.compute(l.emit(), scalars, row.name));
    }
    return l.set(inst.result, std::move(result));
  }
  for (const Whole& row : kWhole) {
    if (row.function != function) continue;
    read_arguments();
    return l.set(inst.result, row.compute(l.emit(), arguments));
  }
  l.unsupported(name_of_glsl_function(function));
}

}  // namespace glint::frontend
