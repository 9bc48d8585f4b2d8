// Folds constants and applies identities of single ops. Every rule gives the bits that the op itself would
// give.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "frontend/lower/emitter.h"

namespace glint::frontend {
namespace {

constexpr Folded no() {
  return {};
}
Folded yes(const Operand& operand) {
  return {true, operand};
}
Folded yes(uint64_t bits) {
  return {true, Operand::value(bits)};
}

bool both_constant(const Operands& s) {
  return s[0].kind == Operand::Kind::Constant && s[1].kind == Operand::Kind::Constant;
}

// Folds the ops that distinguish signed from unsigned, and division where its result is defined.
Folded fold_signed(std::string_view op, int32_t a, int32_t b) {
  if (op == "shr.s32") return yes(uint32_t(a >> (uint32_t(b) > 31 ? 31 : b)));
  if (op == "setp.lt.s32") return yes(a < b);
  if (op == "setp.le.s32") return yes(a <= b);
  if (op == "setp.gt.s32") return yes(a > b);
  if (op == "setp.ge.s32") return yes(a >= b);
  if (b == 0) return no();
  if (op == "div.u32") return yes(uint32_t(a) / uint32_t(b));
  if (op == "rem.u32") return yes(uint32_t(a) % uint32_t(b));
  if (b == -1) return no();  // The lowest number has no negative counterpart.
  if (op == "div.s32") return yes(uint32_t(a / b));
  if (op == "rem.s32") return yes(uint32_t(a % b));
  return no();
}

// Folds the integer ops of two 32-bit constants.
Folded fold_constants(std::string_view op, uint32_t a, uint32_t b) {
  if (op == "add.u32" || op == "add.s32") return yes(uint32_t(a + b));
  if (op == "sub.u32" || op == "sub.s32") return yes(uint32_t(a - b));
  if (op == "mul.lo.u32" || op == "mul.lo.s32") return yes(uint32_t(a * b));
  if (op == "and.b32") return yes(a & b);
  if (op == "or.b32") return yes(a | b);
  if (op == "xor.b32") return yes(a ^ b);
  if (op == "shl.b32") return yes(b > 31 ? 0 : a << b);
  if (op == "shr.u32") return yes(b > 31 ? 0 : a >> b);
  if (op == "setp.eq.u32" || op == "setp.eq.s32") return yes(a == b);
  if (op == "setp.ne.u32" || op == "setp.ne.s32") return yes(a != b);
  if (op == "setp.lt.u32") return yes(a < b);
  if (op == "setp.le.u32") return yes(a <= b);
  if (op == "setp.gt.u32") return yes(a > b);
  if (op == "setp.ge.u32") return yes(a >= b);
  return fold_signed(op, int32_t(a), int32_t(b));
}

Folded fold_identity(std::string_view op, const Operand& a, const Operand& b) {
  const bool is_add = op == "add.u32" || op == "add.s32" || op == "add.u64" || op == "add.s64" ||
                      op == "or.b32" || op == "xor.b32" || op == "or.b64" || op == "xor.b64";
  const bool is_sub = op == "sub.u32" || op == "sub.s32" || op == "sub.u64" || op == "sub.s64" ||
                      op == "shl.b32" || op == "shr.u32" || op == "shr.s32" || op == "shl.b64" ||
                      op == "shr.u64" || op == "shr.s64";
  if ((is_add || is_sub) && is_constant(b, 0)) return yes(a);
  if (is_add && is_constant(a, 0)) return yes(b);
  if (op == "mul.lo.u32" || op == "mul.lo.s32") {
    if (is_constant(a, 0) || is_constant(b, 0)) return yes(0);
    if (is_constant(b, 1)) return yes(a);
    if (is_constant(a, 1)) return yes(b);
  }
  if ((op == "div.u32" || op == "div.s32") && is_constant(b, 1)) return yes(a);
  if (op == "and.b32" && (is_constant(a, 0) || is_constant(b, 0))) return yes(0);
  if (op == "and.b32" && is_constant(b, 0xffff'ffff)) return yes(a);
  constexpr uint64_t kOne = 0x3f80'0000;  // x * 1.0f is x for every x; x + 0.0f is not, because of -0
  if (op == "mul.rn.f32" && is_constant(b, kOne)) return yes(a);
  if (op == "mul.rn.f32" && is_constant(a, kOne)) return yes(b);
  if (op == "div.rn.f32" && is_constant(b, kOne)) return yes(a);
  return no();
}

Folded fold_predicates(std::string_view op, const Operand& a, const Operand& b) {
  if (op == "and.pred") {
    if (is_constant(a, 0) || is_constant(b, 0)) return yes(0);
    if (is_constant(a, 1)) return yes(b);
    if (is_constant(b, 1)) return yes(a);
    if (same(a, b)) return yes(a);
  }
  if (op == "or.pred") {
    if (is_constant(a, 1) || is_constant(b, 1)) return yes(1);
    if (is_constant(a, 0)) return yes(b);
    if (is_constant(b, 0)) return yes(a);
    if (same(a, b)) return yes(a);
  }
  if (op == "xor.pred") {
    if (both_constant({a, b})) return yes(a.constant ^ b.constant);
    if (is_constant(a, 0)) return yes(b);
    if (is_constant(b, 0)) return yes(a);
  }
  return no();
}

}  // namespace

Folded fold(std::string_view op, const Operands& s) {
  if (op == "selp.b32" || op == "selp.b64") {
    if (same(s[0], s[1])) return yes(s[0]);
    if (s[2].kind == Operand::Kind::Constant) return yes(s[2].constant ? s[0] : s[1]);
    return no();
  }
  if (s.size() == 1) {
    if (op == "mov.b32" || op == "mov.b64" || op == "mov.pred") return yes(s[0]);
    if (s[0].kind != Operand::Kind::Constant) return no();
    const uint32_t x = uint32_t(s[0].constant);
    if (op == "neg.f32") return yes(x ^ 0x8000'0000);
    if (op == "neg.s32") return yes(0 - x);
    if (op == "not.b32") return yes(~x);
    if (op == "not.pred") return yes(x ? 0 : 1);
    if (op == "cvt.u64.u32") return yes(x);
    if (op == "cvt.s64.s32") return yes(uint64_t(int64_t(int32_t(x))));
    if (op == "cvt.u32.u64") return yes(x);
    return no();
  }
  if (s.size() == 2) {
    if (op.ends_with(".pred")) return fold_predicates(op, s[0], s[1]);
    if (both_constant(s))
      if (const Folded result = fold_constants(op, uint32_t(s[0].constant), uint32_t(s[1].constant));
          result.folded)
        return result;
    return fold_identity(op, s[0], s[1]);
  }
  if (op == "mad.lo.u32" && is_constant(s[0], 0)) return yes(s[2]);
  return no();
}

}  // namespace glint::frontend
