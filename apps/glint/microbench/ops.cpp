// Measures latency and throughput of ops: a dependent chain of one warp, and chains of 32 warps.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <string_view>

#include "apps/glint/microbench/kernel.h"

namespace glint::app {
namespace {

// Describes a step of a chain through %f1, %d1, %r1, %rd1 or %h1; `kind` says which (f, d, r, l, h). The
// registers %f2, %f3, ... do not change.
struct Step {
  std::string_view name;
  char kind;
  std::string_view text;
  uint32_t slow = 1;  // 8 marks a long sequence, of which fewer are enough
};

constexpr Step kSteps[] = {
    {"add.f32", 'f', "add.f32 %f1,%f1,%f2;"},
    {"mul.f32", 'f', "mul.f32 %f1,%f1,%f2;"},
    {"fma.rn.f32", 'f', "fma.rn.f32 %f1,%f1,%f2,%f3;"},
    {"add.ftz.f32", 'f', "add.ftz.f32 %f1,%f1,%f2;"},
    {"min.f32", 'f', "min.f32 %f1,%f1,%f2;max.f32 %f1,%f1,%f3;"},
    {"div.rn.f32", 'f', "div.rn.f32 %f1,%f1,%f2;", 8},
    {"rcp.rn.f32", 'f', "rcp.rn.f32 %f1,%f1;", 8},
    {"sqrt.rn.f32", 'f', "sqrt.rn.f32 %f1,%f1;", 8},
    {"rcp.approx.ftz.f32 + mul", 'f', "rcp.approx.ftz.f32 %f1,%f1;mul.f32 %f1,%f1,%f2;"},
    {"rsqrt.approx.ftz.f32", 'f', "rsqrt.approx.ftz.f32 %f1,%f1;"},
    {"sqrt.approx.ftz.f32", 'f', "sqrt.approx.ftz.f32 %f1,%f1;"},
    {"ex2.approx.ftz.f32", 'f', "ex2.approx.ftz.f32 %f1,%f1;"},
    {"lg2.approx.ftz.f32", 'f', "lg2.approx.ftz.f32 %f1,%f1;"},
    {"sin.approx.ftz.f32", 'f', "sin.approx.ftz.f32 %f1,%f1;"},
    {"cos.approx.ftz.f32", 'f', "cos.approx.ftz.f32 %f1,%f1;"},
    {"rcp.approx.f32", 'f', "rcp.approx.f32 %f1,%f1;"},
    {"rsqrt.approx.f32", 'f', "rsqrt.approx.f32 %f1,%f1;"},
    {"ex2.approx.f32", 'f', "ex2.approx.f32 %f1,%f1;"},
    {"lg2.approx.f32", 'f', "lg2.approx.f32 %f1,%f1;"},
    {"tanh.approx.f32", 'f', "tanh.approx.f32 %f1,%f1;"},
    {"cvt.rni.f32.f32", 'f', "cvt.rni.f32.f32 %f1,%f1;add.f32 %f1,%f1,%f2;"},
    {"cvt.rzi.s32.f32+iadd+cvt.rn.f32.s32", 'f',
     "cvt.rzi.s32.f32 %r1,%f1;add.s32 %r1,%r1,%r2;cvt.rn.f32.s32 %f1,%r1;"},
    {"cvt.rzi.u32.f32+iadd+cvt.rn.f32.u32", 'f',
     "cvt.rzi.u32.f32 %r1,%f1;add.u32 %r1,%r1,%r2;cvt.rn.f32.u32 %f1,%r1;"},
    {"cvt.f64.f32+cvt.rn.f32.f64", 'f', "cvt.f64.f32 %d1,%f1;add.f64 %d1,%d1,%d2;cvt.rn.f32.f64 %f1,%d1;"},
    {"cvt.rn.f16.f32+cvt.f32.f16", 'f', "cvt.rn.f16.f32 %h1,%f1;cvt.f32.f16 %f1,%h1;"},
    {"setp.lt.f32+selp", 'f', "setp.lt.f32 %p1,%f1,%f2;selp.f32 %f1,%f2,%f3,%p1;"},
    {"setp.lt.f32+@p add", 'f', "setp.lt.f32 %p1,%f1,%f2;@%p1 add.f32 %f1,%f1,%f3;"},
    {"testp/selp NaN", 'f', "testp.notanumber.f32 %p1,%f1;selp.f32 %f1,%f2,%f3,%p1;"},
    {"add.s32", 'r', "add.s32 %r1,%r1,%r2;"},
    {"sub.s32", 'r', "sub.s32 %r1,%r1,%r2;"},
    {"mul.lo.s32", 'r', "mul.lo.s32 %r1,%r1,%r2;"},
    {"mad.lo.s32", 'r', "mad.lo.s32 %r1,%r1,%r2,%r3;"},
    {"mul.hi.s32", 'r', "mul.hi.s32 %r1,%r1,%r2;"},
    {"mul.hi.u32", 'r', "mul.hi.u32 %r1,%r1,%r2;"},
    {"mul24.lo.s32", 'r', "mul24.lo.s32 %r1,%r1,%r2;"},
    {"sad.s32", 'r', "sad.s32 %r1,%r1,%r2,%r3;"},
    {"min.s32+max", 'r', "min.s32 %r1,%r1,%r2;max.s32 %r1,%r1,%r3;"},
    {"and.b32 + add", 'r', "and.b32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;"},
    {"xor+add (lop3,iadd)", 'r', "xor.b32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;"},
    {"lop3.b32(0x1b)", 'r', "lop3.b32 %r1,%r1,%r2,%r3,0x1b;"},
    {"shl.b32(var)", 'r', "shl.b32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;"},
    {"shr.u32(var)", 'r', "shr.u32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;"},
    {"shr.s32(var)", 'r', "shr.s32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;"},
    {"shf.l.wrap", 'r', "shf.l.wrap.b32 %r1,%r1,%r2,%r3;"},
    {"popc.b32", 'r', "popc.b32 %r1,%r1;"},
    {"clz.b32", 'r', "clz.b32 %r1,%r1;"},
    {"bfind.u32", 'r', "bfind.u32 %r1,%r1;"},
    {"brev.b32+add", 'r', "brev.b32 %r1,%r1;add.s32 %r1,%r1,%r2;"},
    {"bfe.u32(var)", 'r', "bfe.u32 %r1,%r1,%r2,%r3;"},
    {"bfi.b32(var)", 'r', "bfi.b32 %r1,%r1,%r2,%r3,%r4;"},
    {"prmt.b32", 'r', "prmt.b32 %r1,%r1,%r2,%r3;"},
    {"dp4a.s32", 'r', "dp4a.s32.s32 %r1,%r1,%r2,%r3;"},
    {"setp.lt.s32+selp", 'r', "setp.lt.s32 %p1,%r1,%r2;selp.b32 %r1,%r2,%r3,%p1;"},
    {"setp.lt.s32+@p add", 'r', "setp.lt.s32 %p1,%r1,%r2;@%p1 add.s32 %r1,%r1,%r3;"},
    {"abs.s32+sub", 'r', "abs.s32 %r1,%r1;sub.s32 %r1,%r1,%r2;"},
    {"div.s32", 'r', "div.s32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;", 8},
    {"div.u32", 'r', "div.u32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;", 8},
    {"rem.s32", 'r', "rem.s32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;", 8},
    {"rem.u32", 'r', "rem.u32 %r1,%r1,%r2;add.s32 %r1,%r1,%r3;", 8},
    {"add.s64", 'l', "add.s64 %rd1,%rd1,%rd2;"},
    {"mul.lo.s64", 'l', "mul.lo.s64 %rd1,%rd1,%rd2;"},
    {"shl.b64+xor", 'l', "shl.b64 %rd1,%rd1,%r2;xor.b64 %rd1,%rd1,%rd3;"},
    {"div.s64", 'l', "div.s64 %rd1,%rd1,%rd2;add.s64 %rd1,%rd1,%rd3;", 8},
    {"mad.wide.u32", 'l', "mad.wide.u32 %rd1,%r1,%r2,%rd1;"},
    {"setp.lt.s64+selp", 'l', "setp.lt.s64 %p1,%rd1,%rd2;selp.b64 %rd1,%rd2,%rd3,%p1;"},
    {"add.f64", 'd', "add.f64 %d1,%d1,%d2;"},
    {"mul.f64", 'd', "mul.f64 %d1,%d1,%d2;"},
    {"fma.rn.f64", 'd', "fma.rn.f64 %d1,%d1,%d2,%d3;"},
    {"div.rn.f64", 'd', "div.rn.f64 %d1,%d1,%d2;", 8},
    {"sqrt.rn.f64", 'd', "sqrt.rn.f64 %d1,%d1;", 8},
    {"rcp.approx.ftz.f64", 'd', "rcp.approx.ftz.f64 %d1,%d1;"},
    {"setp.lt.f64+selp", 'd', "setp.lt.f64 %p1,%d1,%d2;selp.f64 %d1,%d2,%d3,%p1;"},
    {"add.f16", 'h', "add.rn.f16 %h1,%h1,%h2;"},
    {"fma.rn.f16", 'h', "fma.rn.f16 %h1,%h1,%h2,%h3;"},
    {"add.f16x2", 'r', "add.rn.f16x2 %r1,%r1,%r2;"},
    {"fma.rn.f16x2", 'r', "fma.rn.f16x2 %r1,%r1,%r2,%r3;"},
    {"fma.rn.bf16x2", 'r', "fma.rn.bf16x2 %r1,%r1,%r2,%r3;"},
    {"ex2.approx.f16", 'h', "ex2.approx.f16 %h1,%h1;"},
    {"shfl.bfly", 'r', "shfl.sync.bfly.b32 %r1,%r1,1,31,-1;"},
    {"shfl.up+add", 'r', "shfl.sync.up.b32 %r1,%r1,1,0,-1;add.s32 %r1,%r1,%r2;"},
    {"setp+vote.ballot", 'r', "setp.ne.u32 %p1,%r1,%r2;vote.sync.ballot.b32 %r1,%p1,-1;"},
    {"setp+vote.all+selp", 'r',
     "setp.ne.u32 %p1,%r1,%r2;vote.sync.all.pred %p2,%p1,-1;selp.b32 %r1,%r2,%r3,%p2;"},
    {"match.any", 'r', "match.any.sync.b32 %r1,%r1,-1;"},
    {"redux.add.s32", 'r', "redux.sync.add.s32 %r1,%r1,-1;"},
    {"redux.xor.b32", 'r', "redux.sync.xor.b32 %r1,%r1,-1;"},
    {"vote.any+selp", 'r', "setp.ne.u32 %p1,%r1,%r2;vote.sync.any.pred %p2,%p1,-1;selp.b32 %r1,%r2,%r3,%p2;"},
    {"setp+setp.and+selp", 'r',
     "setp.lt.s32 %p1,%r1,%r2;setp.ne.and.u32 %p2,%r1,%r3,%p1;selp.b32 %r1,%r2,%r3,%p2;"},
};

// Returns loads of what a chain begins with and of what its steps read.
std::string loads_of(const std::string& n, int place) {
  const std::string at = "[%rd0+" + std::to_string(place * 8) + "];";
  return "ld.global.f32 %f" + n + "," + at + "ld.global.f64 %d" + n + "," + at + "ld.global.b32 %r" + n +
         "," + at + "ld.global.b64 %rd" + n + "," + at + "ld.global.b16 %h" + n + "," + at;
}

std::string store_of(char kind, const std::string& n) {
  const std::string type = kind == 'f'   ? "f32 [%rd0],%f"
                           : kind == 'd' ? "f64 [%rd0],%d"
                           : kind == 'r' ? "b32 [%rd0],%r"
                           : kind == 'l' ? "b64 [%rd0],%rd"
                                         : "b16 [%rd0],%h";
  return "st.global." + type + n + ";\n";
}

MicroKernel chain_of(const Step& step) {
  MicroKernel kernel;
  for (int i = 1; i <= 4; ++i) kernel.before += loads_of(std::to_string(i), i);
  kernel.before += "bar.sync 0;\n";
  kernel.body = std::string(step.text) + "\n";
  kernel.after = store_of(step.kind, "1");
  kernel.data = {0, 0x40100000'40100000, 0x3ff00000'3f800000, 0x3ff80000'3fc00001, 0x3ff00000'3f800003};
  return kernel;
}

double latency_of(const Step& step, const pipeline::GpuParams& gpu) {
  MicroKernel kernel = chain_of(step);
  kernel.turns = 4;
  return cycles_per_body(kernel, 32 / step.slow, 96 / step.slow, with_one_core(gpu));
}

// Returns the step for a chain of its own. The registers that it changes (registers 1 and the second
// predicate) get the chain's number as a suffix.
std::string step_of_chain(std::string_view text, int chain) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    const bool changes = text[i] == '1' || (text[i] == '2' && text[i - 1] == 'p');
    size_t name = i;
    while (name > 0 && std::islower(text[name - 1])) --name;
    if (changes && name < i && name > 0 && text[name - 1] == '%' && !std::isdigit(text[i + 1]))
      out += std::to_string(chain);
  }
  return out;
}

// Returns the throughput as it was measured on hardware: 32 steps per turn of a warm loop, in eight chains
// per thread. With one chain per thread, the eight warps of a scheduler hide just 16 cycles, and a guarded
// add takes 18. Slow steps have one chain, because hardware calls a function for them.
double throughput_of(const Step& step, const pipeline::GpuParams& gpu) {
  constexpr int kChains = 8;
  const int steps = 32 / int(step.slow), chains = step.slow == 1 ? kChains : 1;
  MicroKernel kernel = chain_of(step);
  kernel.data.resize(5 + kChains, kernel.data[1]);
  kernel.body.clear();
  for (int chain = 0; chain < chains; ++chain) {
    const std::string n = "1" + std::to_string(chain);
    kernel.before += loads_of(n, 5 + chain);
    kernel.after += store_of(step.kind, n);
    kernel.body += step_of_chain(step.text, chain) + "\n";
  }
  kernel.threads = full_block(gpu);
  kernel.unroll = uint32_t(steps / chains);
  return double(steps) * kernel.threads / cycles_per_turn(kernel, 4, 12, with_one_core(gpu));
}

// Describes two kinds of instructions that do not depend on each other, in four chains each, to show which
// pipes they share. # stands for the chain.
struct Mix {
  std::string_view name, text, results;
};
constexpr Mix kMixes[] = {
    {"FFMA + IMAD", "fma.rn.f32 %f1#,%f1#,%f2,%f3;mad.lo.s32 %r1#,%r1#,%r2,%r3;", "fr"},
    {"FFMA + DFMA", "fma.rn.f32 %f1#,%f1#,%f2,%f3;fma.rn.f64 %d1#,%d1#,%d2,%d3;", "fd"},
    {"IMAD + LOP3", "mad.lo.s32 %r1#,%r1#,%r2,%r3;lop3.b32 %r2#,%r2#,%r2,%r3,0x1b;", "rs"},
    {"FFMA + MUFU", "fma.rn.f32 %f1#,%f1#,%f2,%f3;ex2.approx.ftz.f32 %f2#,%f2#;", "fg"},
};
constexpr int kChains = 4;

std::string chains_of(std::string_view text) {
  std::string out;
  for (int i = 0; i < kChains; ++i)
    for (char c : text) out += c == '#' ? std::to_string(i) : std::string(1, c);
  return out + "\n";
}

double mix_of(const Mix& mix, const pipeline::GpuParams& gpu) {
  const std::string body = chains_of(mix.text);
  MicroKernel kernel = chain_of({mix.name, 'f', body});
  for (char kind : mix.results)
    kernel.after += chains_of(kind == 'd'   ? "st.global.f64 [%rd0],%d1#;"
                              : kind == 'f' ? "st.global.f32 [%rd0],%f1#;"
                              : kind == 'g' ? "st.global.f32 [%rd0],%f2#;"
                              : kind == 'r' ? "st.global.b32 [%rd0],%r1#;"
                                            : "st.global.b32 [%rd0],%r2#;");
  kernel.threads = full_block(gpu);
  pipeline::GpuParams in_order = with_one_core(gpu);
  // Scheduling would put the chains of one kind before those of the other.
  in_order.compiler.schedule = false;
  return 2.0 * kChains * 32 / cycles_per_body(kernel, 8, 16, in_order);
}

}  // namespace

std::vector<MicroBench> op_benchmarks() {
  std::vector<MicroBench> out;
  for (const Step& step : kSteps) {
    out.push_back({"latency", std::string(step.name), "", "cycle",
                   [&step](const auto& gpu) { return latency_of(step, gpu); }});
    out.push_back({"throughput", std::string(step.name), "", "lane/cycle",
                   [&step](const auto& gpu) { return throughput_of(step, gpu); }});
  }
  for (const Mix& mix : kMixes)
    out.push_back({"mix", std::string(mix.name), "", "inst/cycle",
                   [&mix](const auto& gpu) { return mix_of(mix, gpu); }});
  return out;
}

}  // namespace glint::app
