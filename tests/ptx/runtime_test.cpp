// Tests what kernels print, what assertions do, and the heap from which kernels take memory.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "exec/print_log.h"
#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

const std::string kVprintf = ".extern .func (.param .b32 r) vprintf(.param .b64 f, .param .b64 a);\n";

// Returns the text as a variable of bytes, as compilers write strings.
std::string text_variable(const std::string& name, const std::string& text) {
  std::string out = ".global .align 1 .b8 " + name + "[" + std::to_string(text.size() + 1) + "] = {";
  for (const char c : text) out += std::to_string(int(c)) + ", ";
  return out + "0};\n";
}

// Calls vprintf with what lies in `depot`.
const std::string kPrint = R"(
    mov.u64 %rd1, depot; cvta.local.u64 %rd2, %rd1; mov.u64 %rd3, $str; cvta.global.u64 %rd4, %rd3;
    { .param .b64 p0; st.param.b64 [p0+0], %rd4; .param .b64 p1; st.param.b64 [p1+0], %rd2; .param .b32 rv;
      call.uni (rv), vprintf, (p0, p1); ld.param.b32 %out, [rv+0]; })";

struct Printed {
  std::string text, fault;
  std::vector<uint32_t> words;
};
Printed run(const std::string& text, uint32_t threads, bool timing) {
  Launcher k(text, "test.ptx", "k");
  exec::PrintLog log;
  k.world().world.prints = &log;
  k.buffer(std::vector<uint32_t>(threads));
  const pipeline::KernelGrid grid{{1, 1, 1}, {threads, 1, 1}, 0};
  Printed out;
  try {
    if (timing)
      k.run_timing(grid, {});
    else
      k.run_functional(grid);
  } catch (const Error& error) {
    out.fault = error.what();
  }
  out.text = log.take();
  out.words = k.read<uint32_t>(0, threads);
  return out;
}

}  // namespace

TEST_CASE("printf prints numbers, characters and texts of each lane, line by line") {
  const std::string variables = kVprintf + text_variable("$str", "%d: %5.2f|%lld|%c|%s|%hhu%%\nand %x, ") +
                                text_variable("$name", "lane");
  const std::string body = R"(
    .local .align 8 .b8 depot[56];
    st.local.u32 [depot], %lane; mov.f64 %d1, 0d3FF8000000000000; st.local.f64 [depot+8], %d1;
    mov.u64 %rd5, -5000000000; st.local.u64 [depot+16], %rd5; add.u32 %r1, %lane, 97; st.local.u32 [depot+24], %r1;
    mov.u64 %rd6, $name; cvta.global.u64 %rd7, %rd6; st.local.u64 [depot+32], %rd7; st.local.u32 [depot+40], 300;
    st.local.u32 [depot+44], 255;)";
  const std::string text = storing(".reg .f64 %d<3>;" + body + kPrint, variables);
  for (const bool timing : {false, true}) {
    const Printed printed = run(text, 2, timing);
    CHECK(printed.text ==
          "0:  1.50|-5000000000|a|lane|44%\n1:  1.50|-5000000000|b|lane|44%\nand ff, \nand ff, \n");
    CHECK(printed.words == std::vector<uint32_t>{7, 7});
  }
}

TEST_CASE("formats that Glint cannot print are named") {
  const auto says = [](const std::string& format, const char* message) {
    const std::string text =
        storing(".local .align 8 .b8 depot[16];" + kPrint, kVprintf + text_variable("$str", format));
    CAPTURE(format, message_of(text));
    CHECK(message_of(text).find(message) != std::string::npos);
  };
  says("%*d", "takes its width from an argument");
  says("%k", "'%k' is not a conversion");
  says("%", "'%' is not a conversion");
  says("%1000d", "has more than 999 characters");
  const std::string unknown = storing(
      ".local .align 8 .b8 depot[8]; ld.param.u64 %rd3, [to];"
      "{ .param .b64 p0; st.param.b64 [p0], %rd3; .param .b64 p1; st.param.b64 [p1], %rd3; .param .b32 rv; "
      "call (rv), vprintf, (p0, p1); }",
      kVprintf);
  CHECK(message_of(unknown).find("a printf whose format is not a constant of the module") !=
        std::string::npos);
}

TEST_CASE("an assertion that does not hold says what it was and ends the launch") {
  const std::string variables =
      ".extern .func __assertfail(.param .b64 m, .param .b64 f, .param .b32 l, .param .b64 "
      "n, .param .b64 s);\n" +
      text_variable("$what", "x % 2 < 9") + text_variable("$file", "a.cu") +
      text_variable("$name", "void k()");
  const std::string body = R"(
    setp.lt.u32 %p1, %lane, 3; @%p1 bra GOOD; mov.u64 %rd1, $what; mov.u64 %rd2, $file; mov.u64 %rd3, $name;
    { .param .b64 a; st.param.b64 [a], %rd1; .param .b64 b; st.param.b64 [b], %rd2; .param .b32 c; st.param.b32 [c], 12;
      .param .b64 d; st.param.b64 [d], %rd3; .param .b64 e; st.param.b64 [e], 1; call.uni __assertfail, (a, b, c, d, e); }
  GOOD: mov.u32 %out, 1;)";
  const std::string text = storing(body, variables);
  CHECK(run(text, 3, false).fault.empty());
  const Printed printed = run(text, 4, true);
  CHECK(printed.text == "a.cu:12: void k(): Assertion `x % 2 < 9` failed.\n");
  CHECK(printed.fault.find("stops itself with a trap") != std::string::npos);
}

TEST_CASE("malloc gives each lane a block of its own until the heap is full") {
  const std::string heap =
      ".extern .func (.param .b64 r) malloc(.param .b64 n);\n.extern .func free(.param .b64 p);\n";
  const std::string take = R"(
    { .param .b64 n; st.param.b64 [n], %rd1; .param .b64 r; call (r), malloc, (n); ld.param.b64 %rd2, [r]; })";
  const std::string body = "mul.wide.u32 %rd1, %lane, 5; add.u64 %rd1, %rd1, 4;" + take + R"(
    st.u32 [%rd2], %lane; bar.warp.sync -1; ld.u32 %out, [%rd2]; and.b64 %rd3, %rd2, 15; cvt.u32.u64 %r1, %rd3;
    mad.lo.u32 %out, %r1, 1000, %out;
    { .param .b64 p; st.param.b64 [p], %rd2; call free, (p); })";
  CHECK(outputs(storing(body, heap)) == expected([](uint32_t lane) { return lane; }));
  frontend::PtxOptions small;
  small.heap_bytes = 64;
  const std::string count =
      "mov.u64 %rd1, 20;" + take + "setp.ne.u64 %p1, %rd2, 0; selp.u32 %out, 1, 0, %p1;";
  uint32_t given = 0;
  for (const uint32_t word : outputs(storing(count, heap), kWarp, small)) given += word;
  CHECK(given == 2);
  const std::string huge = "mov.u64 %rd1, -8;" + take + "setp.ne.u64 %p1, %rd2, 0; selp.u32 %out, 1, 0, %p1;";
  CHECK(outputs(storing(huge, heap)) == std::vector<uint32_t>(32));
}
