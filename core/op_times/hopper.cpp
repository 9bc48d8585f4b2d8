// Implements the op times `hopper`: an H200's times of the ops that differ from their unit, by
// microbenchmarks.
// SPDX-License-Identifier: Apache-2.0

#include "core/op_times.h"

namespace glint::core {
namespace {

using isa::Unit;

// Source: dependent chains, and 32 warps of independent chains, on an NVIDIA H200 (1980 MHz), of PTX ops as
// its assembler translates them. Intervals are 32 lanes x 4 schedulers over the lane operations that a core
// did per cycle. The latency of a step of two ops is split by the other op's latency on its own and by the
// crossing of pipes (1 cycle). The last number, where there is one, is the number of machine instructions of
// the op as they execute without a slow path, from the listings that the same measurements took; `true`
// behind it marks the ops that end in a branch to a slow path. The number is a guess for divisions of 64
// bits, whose listings end at a call. Model: a sequence of instructions holds one pipe for its throughput,
// whatever pipes its parts run on.
constexpr OpTime kTimes[] = {
    // The assembler turns every second addition into a multiply-add on the other pipe: 5 cycles, one per
    // cycle.
    {"add.cc.*", 4, 2},
    {"sub.cc.*", 4, 2},
    {"add.sat.s32", 4, 2},
    {"sub.sat.s32", 4, 2},
    {"add.s32", 5, 1, Unit::Fp32, true},
    {"add.u32", 5, 1, Unit::Fp32, true},
    {"sub.s32", 5, 1, Unit::Fp32, true},
    {"sub.u32", 5, 1, Unit::Fp32, true},
    // Integer multiplication runs on the single-precision pipe, at half its rate.
    {"mul.lo.s32", 4, 2, Unit::Fp32},
    {"mul.lo.u32", 4, 2, Unit::Fp32},
    {"mad.lo.s32", 4, 2, Unit::Fp32},
    {"mad.lo.u32", 4, 2, Unit::Fp32},
    {"mul.hi.s32", 9, 4, Unit::Fp32},
    {"mul.hi.u32", 9, 4, Unit::Fp32},
    {"mad.hi.s32", 9, 4, Unit::Fp32},
    {"mad.hi.u32", 9, 4, Unit::Fp32},
    {"mul.wide.*32", 4, 2.75, Unit::Fp32},
    {"mad.wide.*32", 4, 2.75, Unit::Fp32},
    {"mul24.lo.*", 10, 2, Unit::Fp32, false, 2},
    {"dp4a.*", 4, 2, Unit::Fp32},
    {"mul.lo.*64", 12, 8, Unit::Fp32, false, 4},
    {"mad.lo.*64", 12, 8, Unit::Fp32, false, 4},
    {"mul.hi.*64", 30, 16, Unit::Fp32, false, 8},
    {"mad.hi.*64", 30, 16, Unit::Fp32, false, 8},  // guess: four wide products
    // These ops have two instructions each. A comparison of 64 bits has its result after the second one.
    // 64-bit sums run on two pipes, and only their issue slots limit them.
    {"add.s64", 4, 1, Unit::Int, false, 2},
    {"add.u64", 4, 1, Unit::Int, false, 2},
    {"sub.s64", 4, 1, Unit::Int, false, 2},
    {"sub.u64", 4, 1, Unit::Int, false, 2},
    {"add.wide.*", 4, 1, Unit::Int, false, 2},  // guess: as a sum of 64 bits
    {"and.b64", 4, 4, Unit::Int, false, 2},
    {"or.b64", 4, 4, Unit::Int, false, 2},
    {"xor.b64", 4, 4, Unit::Int, false, 2},
    {"not.b64", 4, 4, Unit::Int, false, 2},
    {"selp.b64", 4, 4, Unit::Int, false, 2},
    {"shl.b64", 6, 2, Unit::Int, false, 2},
    {"rotl.b64", 6, 2, Unit::Int, false, 2},    // guess: as a shift
    {"shladd.u64", 6, 2, Unit::Int, false, 2},  // guess: as a shift
    {"shr.*64", 5, 4, Unit::Int, false, 2},
    {"setp.*.f64", 8, 4.8125},
    {"setp.*64", 8, 4, Unit::Int, false, 2},
    {"abs.s32", 4, 2.625},
    {"bfe.*32", 8, 7.5, Unit::Int, false, 3},
    {"bfi.b32", 8, 9, Unit::Int, false, 4},
    {"min.s64", 13, 4, Unit::Int, false, 4},  // these were listed, not measured
    {"min.u64", 13, 4, Unit::Int, false, 4},
    {"max.s64", 13, 4, Unit::Int, false, 4},
    {"max.u64", 13, 4, Unit::Int, false, 4},
    {"clz.b32", 23, 8, Unit::Count, false, 2},
    // Integer division and remainder are sequences.
    {"div.s32", 131, 33, Unit::Count, false, 23},
    {"div.u32", 124, 29, Unit::Count, false, 17},
    {"rem.s32", 132, 30, Unit::Count, false, 20},
    {"rem.u32", 126, 28, Unit::Count, false, 16},
    {"div.s64", 331, 120, Unit::Count, false, 70, true},
    {"div.u64", 331, 120, Unit::Count, false, 70, true},  // the intervals are guesses
    {"rem.s64", 331, 120, Unit::Count, false, 70, true},  // the intervals are guesses
    {"rem.u64", 331, 120, Unit::Count, false, 58,
     true},  // the interval is a guess; the count is from bench/probes
    // Comparisons, minima and the like run on the integer pipe.
    {"setp.*.f32", 4, 2, Unit::Int},
    {"set.*.f32", 4, 2, Unit::Int},
    {"testp.*.f32", 4, 2, Unit::Int},
    {"min.*f32", 4, 2, Unit::Int},
    {"max.*f32", 4, 2, Unit::Int},
    {"add.rn*.f16x2", 8, 1},
    {"mul.rn*.f16x2", 8, 1},
    {"fma.rn*.f16x2", 8, 1},
    {"fma.rn*.bf16x2", 8, 1},
    // These are sequences around the special-function unit.
    {"div.rn.f32", 57, 17, Unit::Count, false, 10, true, SlowPath::DivF32},
    {"div.rn.ftz.f32", 57, 17, Unit::Count, false, 10, true, SlowPath::DivFtzF32},
    {"rcp.rn*.f32", 77, 12, Unit::Count, false, 10, true, SlowPath::RcpF32},
    {"sqrt.rn.f32", 55, 11, Unit::Count, false, 11, true, SlowPath::SqrtF32},
    {"sqrt.rn.ftz.f32", 55, 11, Unit::Count, false, 11, true, SlowPath::SqrtFtzF32},
    {"rcp.approx.f32", 41, 8.5625, Unit::Count, false, 7},
    {"rsqrt.approx.f32", 39, 8, Unit::Count, false, 4},
    {"lg2.approx.f32", 39, 8, Unit::Count, false, 4},
    {"sqrt.approx.f32", 39, 8, Unit::Count, false, 4},
    // In a chain of its own results the assembler leaves out the scaling of small operands, which kernels
    // have.
    {"ex2.approx.f32", 39, 8, Unit::Count, false, 4},
    {"sin.approx*", 23, 8, Unit::Count, false, 2},
    {"cos.approx*", 23, 8, Unit::Count, false, 2},
    {"div.approx.ftz*", 23, 8, Unit::Count, false, 2},
    {"div.approx.f32", 44, 8, Unit::Count, false,
     6},                                          // its sequence was listed, its latency is a guess by it
    {"div.full*", 40, 8, Unit::Count, false, 7},  // rcp and mul
    {"rcp.approx.ftz.f64", 17, 8, Unit::Sfu},
    {"rsqrt.approx.ftz.f64", 17, 8, Unit::Sfu},
    {"fma.r*.f64", 8, 2.1875},  // three operands of 64 bits, so reads of registers hold it up
    {"div.r*.f64", 124, 26, Unit::Count, false, 16, true, SlowPath::DivF64},
    {"sqrt.rn.f64", 92, 28, Unit::Count, false, 15, true, SlowPath::SqrtF64},
    {"rcp.rn.f64", 92, 20, Unit::Count, false, 11, true, SlowPath::RcpF64},  // guess
    // A function returns, which is fitted to calls of one, two and four functions
    // (bench/probes/calls_h200.csv): parameters lie in local memory here.
    {"ret", 53, 2},
    // These are conversions.
    {"cvt.rn.f32.s32", 4, 2, Unit::Int},
    {"cvt.rn.f32.u32", 4, 2, Unit::Int},
    {"cvt.rn.f16.f32", 4, 2, Unit::Int},
    {"cvt.f32.f16", 4, 1, Unit::Fp32},
    {"cvt.f64.f32", 18, 8.5, Unit::Sfu},
    {"cvt.rn.f32.f64", 18, 8.5, Unit::Sfu},
    // Products of matrices have a pipe of their own (bench/probes/tensor_h200.csv). Ops that are not named
    // here have the time of the unit: m16n8k16 of f16 and bf16, m16n8k32 of bytes, m16n8k256 of bits.
    {"mma.sync.aligned.m16n8k8.*tf32.f32", 24, 6},
    {"mma.sync.aligned.m16n8k8.*", 17, 4},
    {"mma.sync.aligned.m16n8k4.*", 17, 4},
    {"mma.sync.aligned.m16n8k16.*s32", 17, 4},
    {"mma.sync.aligned.m8n8k16.*", 14, 4},
    {"mma.sync.aligned.m8n8k4.*", 26, 16},
    {"mma.sync.aligned.m8n8k128.*and.popc", 14, 4},
    {"mma.sync.aligned.m16n8k128.*and.popc", 17, 4},
    // The part has no products of 4 bits, and of bits only those of `and`: its assembler calls functions.
    {"mma.sync.aligned.m8n8k32.*", 169, 107, Unit::Count, false, 66, true},
    {"mma.sync.aligned.m16n8k32.*4.s32", 187, 127, Unit::Count, false, 72, true},
    {"mma.sync.aligned.m16n8k64.*", 536, 328, Unit::Count, false, 208, true},
    {"mma.sync.aligned.m8n8k128.*xor.popc", 91, 27, Unit::Count, false, 9, true},
    {"mma.sync.aligned.m16n8k128.*xor.popc", 99, 35, Unit::Count, false, 14, true},
    {"mma.sync.aligned.m16n8k256.*xor.popc", 115, 43, Unit::Count, false, 16, true},
    {"movmatrix.*", 24, 4},
    // These work across lanes.
    {"vote.*", 13, 2, Unit::Int},
    {"match.*", 28, 8},
    {"shfl.sync.up.*", 24, 4},
    {"shfl.sync.down.*", 24, 4},
    {"redux.*", 44, 8, Unit::Count, false, 2},
};

class Hopper final : public OpTimes {
 public:
  static constexpr std::string_view kName = "hopper";
  static constexpr std::string_view kDoc =
      "Ops that differ from their unit on an NVIDIA H200 have the measured times.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Hopper(Params, Context) {}
  std::span<const OpTime> entries() const override { return kTimes; }
};

const Register<OpTimes, Hopper> registered;

}  // namespace
}  // namespace glint::core
