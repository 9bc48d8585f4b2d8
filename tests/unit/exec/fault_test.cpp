// Tests faults of programs written as text: what is let pass and what stops, space by space.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::exec {
namespace {

using Catch::Contains;

const std::string kStore = "    st.global.v2.b32 [%rd2], {%r10, %r11};\n    exit;\n";

// Runs one thread that goes on after faults, and returns the log.
FaultLog passed(TextLaunch& launch) {
  launch.world.on_fault = OnFault::Warn;
  return pipeline::run_functional(launch.world, 1'000'000, {}).faults;
}

}  // namespace

TEST_CASE("loads that go nowhere give 0 in all their registers, in every space") {
  for (const std::string load : {"ld.global.v2.b32 {%r10, %r11}, [%rd2 + 4096];",
                                 "mov.b32 %r6, 64; ld.shared.v2.b32 {%r10, %r11}, [%r6];",
                                 "mov.b32 %r6, 1048576; ld.const.v2.b32 {%r10, %r11}, [%r6];",
                                 "mov.b32 %r6, 1048576; ld.param.v2.b32 {%r10, %r11}, [%r6];",
                                 "atom.global.add.u64 %rd10, [%rd2 + 4096], 1;",
                                 "cvta.local.u64 %rd4, 0; atom.add.u64 %rd10, [%rd4], 1;"}) {
    CAPTURE(load);
    TextLaunch launch("    ld.param.b64 %rd2, [0];\n    mov.b32 %r10, 5;\n    mov.b32 %r11, 6;\n    " + load +
                          "\n" + kStore,
                      {.block = {1, 1, 1}, .shared_bytes = 64, .local_bytes = 64});
    launch.word(0) = launch.word(1) = 9;
    const FaultLog log = passed(launch);
    CHECK(log.count(FaultKind::OutOfBounds) == 1);
    CHECK(launch.words(0, 2) == std::vector<uint32_t>{0, 0});
  }
}

TEST_CASE("a store to the constant bank is dropped and told") {
  TextLaunch launch("    cvta.const.u64 %rd2, 64;\n    st.b32 [%rd2], 1;\n    exit;\n", {.block = {1, 1, 1}});
  CHECK_THAT(passed(launch).to_string(), Contains("the constant bank, which can only be read"));
  CHECK(std::to_integer<int>(launch.world.constant_bank[64]) == 0);
}

TEST_CASE("a misaligned store goes to the multiple of its size below") {
  TextLaunch launch("    ld.param.b64 %rd2, [0];\n    st.global.b32 [%rd2 + 7], 3;\n    exit;\n",
                    {.block = {1, 1, 1}});
  const FaultLog log = passed(launch);
  CHECK(log.count(FaultKind::Misaligned) == 1);
  CHECK(launch.words(0, 3) == std::vector<uint32_t>{0, 3, 0});
}

TEST_CASE("a frame that does not fit into the stack ends the run whether faults are let pass or not") {
  for (const OnFault on_fault : {OnFault::Stop, OnFault::Warn}) {
    TextLaunch launch("    mov.b32 %r0, 48;\n    st.local.b32 [%r0 + 28], 1;\n    exit;\n",
                      {.block = {1, 1, 1}, .local_bytes = 64});
    launch.world.on_fault = on_fault;
    CHECK_THAT(launch.fault(), Contains("the stack of a lane has 64 bytes, and it overflows: 48 are in use "
                                        "and the shader's frame takes 64"));
  }
}

TEST_CASE("a trap ends the run whether faults are let pass or not") {
  TextLaunch launch("    setp.eq.u32 %p0, 0, 0;\n    @%p0 trap;\n    exit;\n", {.block = {1, 1, 1}});
  launch.world.on_fault = OnFault::Warn;
  CHECK_THAT(launch.fault(), Contains("the program stops itself with a trap"));
}

TEST_CASE("robust buffers give 0 and drop stores outside without noting it") {
  TextLaunch launch(
      "    ld.param.b64 %rd2, [0];\n    st.global.b32 [%rd2 + 4096], 1;\n    ld.global.v2.b32 {%r10, %r11}, "
      "[%rd2 + 4096];\n" +
          kStore,
      {.block = {1, 1, 1}});
  launch.world.robust_buffers = true;
  launch.word(0) = 9;
  CHECK(launch.fault() == "");
  CHECK(launch.words(0, 2) == std::vector<uint32_t>{0, 0});
}

TEST_CASE("of a vector that reaches across the end of a robust buffer the words inside are moved") {
  TextLaunch launch(
      "    ld.param.b64 %rd2, [0];\n    ld.global.v4.b32 {%r10, %r11, %r12, %r13}, [%rd2 + 4080];\n"
      "    st.global.v4.b32 [%rd2], {%r10, %r11, %r12, %r13};\n    mov.b32 %r14, 7;\n"
      "    st.global.v4.b32 [%rd2 + 4080], {%r14, %r14, %r14, %r14};\n"
      "    ld.global.b64 %rd16, [%rd2 + 4088];\n    st.global.b64 [%rd2 + 16], %rd16;\n    exit;\n",
      {.block = {1, 1, 1}, .buffer_words = 1023});
  launch.world.robust_buffers = true;
  for (uint32_t i = 0; i < 3; ++i) launch.word(1020 + i) = 21 + i;
  launch.word(4) = launch.word(5) = 9;
  CHECK(launch.fault() == "");
  CHECK(launch.words(0, 4) == std::vector<uint32_t>{21, 22, 23, 0});
  CHECK(launch.words(1020, 3) == std::vector<uint32_t>{7, 7, 7});
  CHECK(launch.words(4, 2) == std::vector<uint32_t>{0, 0});  // 64 bits are one value
}

}  // namespace glint::exec
