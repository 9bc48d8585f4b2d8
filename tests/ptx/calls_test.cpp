// Tests calls of PTX functions that have code of their own: recursion, addresses of functions, frames.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

// Returns the words of a warp on both machines and with the text as it stands, which have to agree.
std::vector<uint32_t> everywhere(const std::string& text) {
  const std::vector<uint32_t> words = outputs(text);
  frontend::PtxOptions plain;
  plain.shape = false;
  CHECK(outputs(text, kWarp, plain) == words);
  Launcher timed(text, "test.ptx", "k");
  timed.buffer(std::vector<uint32_t>(32));
  pipeline::GpuParams params;
  params.cores = 2;
  timed.run_timing(kWarp, params);
  CHECK(timed.read<uint32_t>(0, 32) == words);
  return words;
}

std::string fault_of(const std::string& text, pipeline::KernelGrid grid = kWarp) {
  try {
    outputs(text, grid);
  } catch (const Error& error) {
    return error.what();
  }
  return "no fault";
}

const std::string kFactorial = R"(
  .func (.param .b32 r) factorial(.param .b32 n)
  { .reg .b32 %n, %m, %a; .reg .pred %p; ld.param.u32 %n, [n]; setp.lt.u32 %p, %n, 2; mov.u32 %a, 1;
    @%p bra DONE; sub.u32 %m, %n, 1;
    { .param .b32 x; st.param.b32 [x+0], %m; .param .b32 y; call.uni (y), factorial, (x); ld.param.b32 %m, [y+0]; }
    mul.lo.u32 %a, %n, %m;
  DONE: st.param.b32 [r], %a; ret; })";

}  // namespace

TEST_CASE("functions call themselves and each other") {
  const std::string body = R"(
    and.b32 %r1, %lane, 7;
    { .param .b32 x; st.param.b32 [x], %r1; .param .b32 y; call (y), factorial, (x); ld.param.b32 %out, [y]; }
    mad.lo.u32 %out, %r1, 100000, %out;)";
  CHECK(everywhere(storing(body, kFactorial)) == expected([](uint32_t lane) {
          uint32_t product = 1;
          for (uint32_t n = 2; n <= lane % 8; ++n) product *= n;
          return product + lane % 8 * 100000;
        }));
  const std::string pair = R"(
    .func (.param .b32 r) odd(.param .b32 n);
    .func (.param .b32 r) even(.param .b32 n)
    { .reg .b32 %n; .reg .pred %p; ld.param.u32 %n, [n]; setp.ne.u32 %p, %n, 0; @%p bra MORE;
      st.param.b32 [r], 1; ret;
    MORE: sub.u32 %n, %n, 1;
      { .param .b32 x; st.param.b32 [x], %n; .param .b32 y; call (y), odd, (x); ld.param.b32 %n, [y]; }
      st.param.b32 [r], %n; ret; }
    .func (.param .b32 r) odd(.param .b32 n)
    { .reg .b32 %n; .reg .pred %p; ld.param.u32 %n, [n]; setp.ne.u32 %p, %n, 0; @%p bra MORE;
      st.param.b32 [r], 0; ret;
    MORE: sub.u32 %n, %n, 1;
      { .param .b32 x; st.param.b32 [x], %n; .param .b32 y; call (y), even, (x); ld.param.b32 %n, [y]; }
      st.param.b32 [r], %n; ret; })";
  const std::string asks = R"(
    { .param .b32 x; st.param.b32 [x], %lane; .param .b32 y; call (y), even, (x); ld.param.b32 %out, [y]; })";
  CHECK(everywhere(storing(asks, pair)) == expected([](uint32_t lane) { return (lane + 1) % 2; }));
}

TEST_CASE("a register calls what it holds: from a table, by a list of targets, under a guard") {
  const std::string functions = kFactorial + R"(
    .func (.param .b32 r) minus(.param .b32 n)
    { .reg .b32 %n; ld.param.u32 %n, [n]; neg.s32 %n, %n; st.param.b32 [r], %n; ret; }
    .func (.param .b32 r) plus(.param .b32 n)
    { .reg .b32 %n; ld.param.u32 %n, [n]; add.u32 %n, %n, 500; st.param.b32 [r], %n; ret; }
    .global .align 8 .u64 table[3] = {minus, plus, factorial};)";
  const std::string body = R"(
    rem.u32 %r1, %lane, 3; mul.wide.u32 %rd1, %r1, 8; mov.u64 %rd2, table; add.u64 %rd1, %rd1, %rd2;
    ld.global.u64 %rd3, [%rd1]; and.b32 %r2, %lane, 3; setp.lt.u32 %p1, %lane, 30; mov.u32 %r3, 77;
    { .param .b32 x; st.param.b32 [x], %r2; .param .b32 y; st.param.b32 [y], %r3;
      how: .callprototype (.param .b32 _) _ (.param .b32 _);
      @%p1 call (y), %rd3, (x), how; ld.param.b32 %out, [y]; }
    mov.u64 %rd4, plus;
    { .param .b32 x; st.param.b32 [x], %out; .param .b32 y; which: .calltargets plus, minus;
      call (y), %rd4, (x), which; ld.param.b32 %out, [y]; })";
  CHECK(everywhere(storing(body, functions)) == expected([](uint32_t lane) {
          const uint32_t n = lane % 4;
          const uint32_t answers[] = {0 - n, n + 500, n < 2 ? 1u : n == 2 ? 2u : 6u};
          return (lane < 30 ? answers[lane % 3] : 77) + 500;
        }));
}

TEST_CASE("a called function has variables, wide and narrow parameters, and registers of its own") {
  const std::string functions = R"(
    .func (.param .align 8 .b8 r[16]) mix(.param .b64 a, .param .align 4 .b8 s[12], .param .b16 h, .param .b32 depth)
    { .local .align 8 .b8 depot[24]; .reg .b64 %a, %SP, %w; .reg .b32 %x, %y, %d; .reg .b16 %h; .reg .pred %p;
      ld.param.u64 %a, [a]; ld.param.u32 %x, [s+8]; ld.param.s16 %h, [h]; ld.param.u32 %d, [depth];
      mov.u64 %SP, depot; st.local.u64 [%SP], %a; st.local.u32 [depot+8], %x; st.local.u32 [%SP+12], %d;
      setp.eq.u32 %p, %d, 0; @%p bra LAST;
      sub.u32 %d, %d, 1; add.u64 %a, %a, 3;
      { .param .b64 pa; st.param.b64 [pa], %a; .param .align 4 .b8 ps[12]; st.param.b32 [ps+8], %x;
        .param .b16 ph; st.param.b16 [ph], %h; .param .b32 pd; st.param.b32 [pd], %d; .param .align 8 .b8 pr[16];
        call (pr), mix, (pa, ps, ph, pd); ld.param.b64 %w, [pr]; ld.param.b32 %y, [pr+8]; }
      ld.local.u64 %a, [%SP]; ld.local.u32 %x, [depot+8]; ld.local.u32 %d, [%SP+12];
      add.u64 %w, %w, %a; mad.lo.u32 %y, %d, 10, %y; add.u32 %y, %y, %x;
      st.param.b64 [r], %w; st.param.b32 [r+8], %y; ret;
    LAST: cvt.s32.s16 %y, %h; st.param.b64 [r], %a; st.param.b32 [r+8], %y; ret; })";
  const std::string body = R"(
    .local .align 4 .b8 mine[8]; st.local.u32 [mine], %lane; and.b32 %r3, %lane, 3;
    cvt.u64.u32 %rd1, %lane; add.u64 %rd1, %rd1, 0x100000000;
    { .param .b64 pa; st.param.b64 [pa], %rd1; .param .align 4 .b8 ps[16]; st.param.b32 [ps+8], 7;
      .param .b16 ph; st.param.b16 [ph], 0xfff0; .param .b32 pd; st.param.b32 [pd], %r3; .param .align 8 .b8 pr[16];
      call (pr), mix, (pa, ps, ph, pd); ld.param.b64 %rd2, [pr]; ld.param.b32 %r1, [pr+8]; }
    ld.local.u32 %r2, [mine]; shr.u64 %rd3, %rd2, 32; cvt.u32.u64 %r4, %rd3; cvt.u32.u64 %r5, %rd2;
    mad.lo.u32 %out, %r4, 10000, %r1; add.u32 %out, %out, %r2; mad.lo.u32 %out, %r5, 7, %out;)";
  CHECK(everywhere(storing(body, functions)) == expected([](uint32_t lane) {
          const uint32_t depth = lane % 4;
          uint32_t low = 0, second = uint32_t(-16);
          for (uint32_t d = 0; d <= depth; ++d) {
            low += lane + 3 * d;
            if (d > 0) second += 10 * d + 7;
          }
          return (depth + 1) * 10000 + second + lane + 7 * low;
        }));
}

TEST_CASE("kernels of a module agree about the addresses of functions, and share its variables") {
  const std::string module = kHead + R"(
    .global .align 8 .u64 chosen; .global .u32 seen;
    .func (.param .b32 r) first(.param .b32 n) { .reg .b32 %n; ld.param.u32 %n, [n]; add.u32 %n, %n, 1; st.param.b32 [r], %n; ret; }
    .func (.param .b32 r) second(.param .b32 n) { .reg .b32 %n; ld.param.u32 %n, [n]; add.u32 %n, %n, 2; st.param.b32 [r], %n; ret; }
    .visible .entry choose() { .reg .b64 %d; .reg .b32 %r; mov.u64 %d, second; st.global.u64 [chosen], %d;
      atom.global.add.u32 %r, [seen], 5; ret; }
    .visible .entry use(.param .u64 to) { .reg .b64 %d, %f; .reg .b32 %r, %s; ld.param.u64 %d, [to]; ld.global.u64 %f, [chosen];
      ld.global.u32 %s, [seen];
      { .param .b32 x; st.param.b32 [x], %s; .param .b32 y; how: .callprototype (.param .b32 _) _ (.param .b32 _);
        call (y), %f, (x), how; ld.param.b32 %r, [y]; }
      st.global.u32 [%d], %r; ret; })";
  const auto memory = std::make_shared<mem::AddressSpace>();
  pipeline::ModuleVariables variables;
  pipeline::KernelWorld choose(frontend::compile_ptx(module, "m.ptx", "choose", {}), memory, &variables);
  pipeline::KernelWorld use(frontend::compile_ptx(module, "m.ptx", "use", {}), memory, &variables);
  const Address to = memory->allocate("to", 4);
  choose.set_grid({});
  choose.set_arguments({});
  pipeline::run_functional(choose.world, 1000, {});
  use.set_grid({});
  use.set_arguments({pipeline::KernelWorld::argument(to)});
  pipeline::run_functional(use.world, 1000, {});
  CHECK(memory->view<uint32_t>(to, 1)[0] == 7);
}

TEST_CASE("recursion without end and calls of nothing are faults that say what to do") {
  const std::string endless = R"(
    .func (.param .b32 r) again(.param .b32 n)
    { .reg .b32 %n; ld.param.u32 %n, [n]; { .param .b32 x; st.param.b32 [x], %n; .param .b32 y; call (y), again, (x);
      ld.param.b32 %n, [y]; } add.u32 %n, %n, 1; st.param.b32 [r], %n; ret; })";
  const std::string calls = storing(
      "{ .param .b32 x; st.param.b32 [x], 1; .param .b32 y; call (y), again, (x); ld.param.b32 %out, [y]; }",
      endless);
  CHECK(fault_of(calls).find("the stack of a lane has 8") != std::string::npos);
  CHECK(fault_of(calls).find("'stack_bytes'") != std::string::npos);
  const std::string without = storing("call again;", ".func again() { call again; ret; }");
  CHECK(fault_of(without).find("nested without end") != std::string::npos);
  const std::string null =
      storing("mov.u64 %rd1, 0; how: .callprototype _ (); call %rd1, (), how;", ".func f() { ret; }");
  CHECK(fault_of(null).find("calls through a null address") != std::string::npos);
}

TEST_CASE("mistakes in calls through registers name their line") {
  CHECK(message_of(storing("mov.u64 %rd1, 0; call %rd1, ();"))
            .find("a call through the register '%rd1' ends with the name of a .callprototype") !=
        std::string::npos);
  CHECK(message_of(storing("call %rd77, ();")).find("there is no function '%rd77'") != std::string::npos);
  CHECK(message_of(storing("how: .callprototype _ (.param .b32 _); call %rd1, (), how;"))
            .find("'%rd1' takes 1 parameters and gives 0 results, but the call has 0 and 0") !=
        std::string::npos);
}
