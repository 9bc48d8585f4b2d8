// Tests loads and stores of every width in every space, and generic addresses of each window.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fmt/format.h>
#include <utility>

#include "isa/generic_address.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::exec {
namespace {

// Returns a program in which one thread stores and loads in all widths at the base that `place` writes down,
// and leaves ten words.
std::string all_widths(const std::string& space, const std::string& base, int offset) {
  const auto at = [&](int n) {
    return base.empty() ? fmt::format("[{}]", n) : fmt::format("[{} + {}]", base, offset + n);
  };
  std::string text;
  text += fmt::format("    st{}.b32 {}, 0x818283f4;\n", space, at(0));
  text += fmt::format("    st{}.b8 {}, 0x1ff;\n", space, at(1));
  text += fmt::format("    st{}.b16 {}, 0x12345;\n", space, at(2));
  text += fmt::format("    ld{}.b32 %r10, {};\n", space, at(0));
  text += fmt::format("    ld{}.s8 %r11, {};\n", space, at(0));
  text += fmt::format("    ld{}.u8 %r12, {};\n", space, at(0));
  text += fmt::format("    ld{}.s16 %r13, {};\n", space, at(0));
  text += fmt::format("    ld{}.v4.s8 {{%r14, %r15, %r16, %r17}}, {};\n", space, at(0));
  text += fmt::format("    st{}.v2.b16 {}, {{%r10, 0xffff0007}};\n", space, at(4));
  text += fmt::format("    ld{}.v2.u16 {{%r18, %r19}}, {};\n", space, at(4));
  text += fmt::format("    st{}.v2.b64 {}, {{1, 2, 3, 4}};\n", space, at(16));
  text += fmt::format("    ld{}.b64 %rd20, {};\n", space, at(24));
  return text + R"(
    st.global.v4.b32 [%rd2], {%r10, %r11, %r12, %r13};
    st.global.v4.b32 [%rd2 + 16], {%r14, %r15, %r16, %r17};
    st.global.v4.b32 [%rd2 + 32], {%r18, %r19, %r20, %r21};
    exit;
)";
}
const std::vector<uint32_t> kAllWidths = {
    0x2345'fff4, 0xffff'fff4, 0xf4, 0xffff'fff4, 0xffff'fff4, 0xffff'ffff, 0x45, 0x23, 0xfff4, 7, 3, 4};

constexpr const char* kBuffer = "    ld.param.b64 %rd2, [0];\n";

}  // namespace

TEST_CASE("every width loads and stores in every space, by its own address and by a generic one") {
  struct Way {
    std::string space, setup, base;
    int offset;
  };
  const Way ways[] = {{".global", "", "%rd2", 512},
                      {".shared", "", "", 0},
                      {".local", "", "", 0},
                      {"", "    cvta.global.u64 %rd4, %rd2;\n", "%rd4", 512},
                      {"", "    cvta.shared.u64 %rd4, 32;\n", "%rd4", 32},
                      {"", "    cvta.local.u64 %rd4, 32;\n", "%rd4", 0}};
  for (const Way& way : ways) {
    CAPTURE(way.space, way.setup);
    TextLaunch launch(kBuffer + way.setup + all_widths(way.space, way.base, way.offset),
                      {.block = {1, 1, 1}, .shared_bytes = 128, .local_bytes = 128});
    launch.run();

    CHECK(launch.words(0, 12) == kAllWidths);
  }
}

TEST_CASE("constants and parameters load in every width, by a generic address too") {
  for (const auto& [setup, space, base] : {std::array<std::string, 3>{"", ".param", "8"},
                                           {"", ".const", "16392"},
                                           {"    cvta.param.u64 %rd4, 8;\n", "", "%rd4"},
                                           {"    cvta.const.u64 %rd4, 16392;\n", "", "%rd4"}}) {
    CAPTURE(setup, space);
    TextLaunch launch(kBuffer + setup + "    ld" + space + ".b64 %rd10, [" + base + "];\n    ld" + space +
                          ".v2.s16 {%r12, %r13}, [" + base +
                          "];\n    st.global.v4.b32 [%rd2], {%r10, %r11, %r12, %r13};\n    exit;\n",
                      {.block = {1, 1, 1}});
    const uint64_t value = 0x1234'5678'8001'7ffe;
    std::memcpy(launch.world.constant_bank.data() + isa::kPushConstantOffset + 8, &value, 8);
    launch.run();

    CHECK(launch.words(0, 4) == std::vector<uint32_t>{0x8001'7ffe, 0x1234'5678, 0x7ffe, 0xffff'8001});
  }
}

TEST_CASE("the lanes of one generic access may be in four different spaces") {
  TextLaunch launch(kOwnWord + R"(
    st.shared.b32 [4], 20;
    st.local.b32 [4], 30;
    rem.u32 %r5, %r4, 4;
    add.u64 %rd6, %rd2, 512;
    st.global.b32 [%rd6], 10;
    cvta.shared.u64 %rd8, 4;
    cvta.local.u64 %rd10, 4;
    cvta.const.u64 %rd12, 16392;
    setp.eq.u32 %p1, %r5, 1;
    setp.eq.u32 %p2, %r5, 2;
    setp.eq.u32 %p3, %r5, 3;
    selp.b64 %rd6, %rd8, %rd6, %p1;
    selp.b64 %rd6, %rd10, %rd6, %p2;
    selp.b64 %rd6, %rd12, %rd6, %p3;
    ld.b32 %r14, [%rd6];
    st.global.b32 [%rd2], %r14;
    exit;
)",
                    {.shared_bytes = 8, .local_bytes = 8});
  const uint32_t value = 40;
  std::memcpy(launch.world.constant_bank.data() + 16392, &value, 4);
  launch.run();

  for (uint32_t i = 0; i < 32; ++i) CHECK(launch.word(i) == 10 * (i % 4 + 1));
}

TEST_CASE("isspacep tells the windows apart, and conversions undo each other") {
  TextLaunch launch(std::string(kBuffer) + R"(
    cvta.shared.u64 %rd4, 12;
    isspacep.shared %p0, %rd4;
    isspacep.global %p1, %rd4;
    isspacep.local %p2, %rd4;
    isspacep.const %p3, %rd4;
    isspacep.global %p4, %rd2;
    cvta.to.shared.u64 %rd6, %rd4;
    cvta.param.u64 %rd8, 4;
    isspacep.const %p5, %rd8;
    isspacep.param %p6, %rd8;
    mov.b32 %r10, 0;
    selp.b32 %r11, 1, 0, %p0;
    or.b32 %r10, %r10, %r11;
    selp.b32 %r11, 2, 0, %p1;
    or.b32 %r10, %r10, %r11;
    selp.b32 %r11, 4, 0, %p2;
    or.b32 %r10, %r10, %r11;
    selp.b32 %r11, 8, 0, %p3;
    or.b32 %r10, %r10, %r11;
    selp.b32 %r11, 16, 0, %p4;
    or.b32 %r10, %r10, %r11;
    selp.b32 %r11, 32, 0, %p5;
    or.b32 %r10, %r10, %r11;
    selp.b32 %r11, 64, 0, %p6;
    or.b32 %r10, %r10, %r11;
    st.global.b32 [%rd2], %r10;
    st.global.b64 [%rd2 + 8], %rd6;
    exit;
)",
                    {.block = {1, 1, 1}});
  launch.run();

  CHECK(launch.word(0) == 1 + 16 + 32 + 64);
  CHECK(launch.word(2) == 12);
  CHECK(launch.word(3) == 0);
}

TEST_CASE("an access that is not aligned to its size is a fault") {
  const auto fault = [](const std::string& instruction) {
    TextLaunch launch(kBuffer + ("    " + instruction) + "\n    exit;\n",
                      {.block = {1, 1, 1}, .shared_bytes = 64, .local_bytes = 64});
    return launch.fault();
  };
  for (const auto& [instruction, text] :
       {std::pair{"ld.global.b32 %r4, [%rd2 + 2];", "which is not a multiple of 4"},
        {"st.global.v4.b32 [%rd2 + 8], {1, 2, 3, 4};", "which is not a multiple of 16"},
        {"mov.b32 %r6, 4; ld.shared.b64 %rd4, [%r6];",
         "reads 8 bytes at shared address 0x4, which is not a multiple of 8"},
        {"mov.b32 %r6, 1; ld.local.b16 %r4, [%r6];", "which is not a multiple of 2"},
        {"mov.b32 %r6, 4; ld.param.b64 %rd4, [%r6];",
         "reads 8 bytes at parameter address 0x4, which is not a multiple of 8"}}) {
    CAPTURE(instruction);
    CHECK(fault(instruction).find(text) != std::string::npos);
  }
  CHECK(fault("ld.global.b32 %r4, [%rd2 + 4];") == "");
}

TEST_CASE("a store through a generic address may not reach the constant bank") {
  TextLaunch launch("    cvta.const.u64 %rd2, 0;\n    st.b32 [%rd2], 1;\n    exit;\n", {});

  CHECK(launch.fault().find("the constant bank, which can only be read") != std::string::npos);
}

TEST_CASE("windows do not meet global memory") {
  for (const isa::Space space : {isa::Space::Const, isa::Space::Shared, isa::Space::Local}) {
    CHECK(isa::space_of(isa::window_of(space)) == space);
    CHECK(isa::space_of(isa::window_of(space) + isa::kWindowBytes - 1) == space);
  }
  CHECK(isa::space_of(0) == isa::Space::Global);
  CHECK(isa::space_of(~uint64_t{0}) == isa::Space::Global);
}

}  // namespace glint::exec
