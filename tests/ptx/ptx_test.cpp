// Tests the PTX front end by small kernels: memory and variables, and how mistakes are reported.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

TEST_CASE("variables of the module lie in their spaces with their values and pointers") {
  const std::string variables = R"(
    .global .align 4 .u32 table[4] = {10, 20, 30, 40};
    .global .u64 where = table+8;
    .const .align 4 .u32 steps[2] = {5, 7};
    .extern .shared .align 16 .b8 dynamic[];
    .shared .align 4 .u32 fixed[32];)";
  const std::string body = R"(
    ld.global.u64 %rd1, [where];
    ld.u32 %r1, [%rd1];
    ld.const.u32 %r2, [steps+4];
    mov.u64 %rd2, table; ld.global.u32 %r3, [%rd2+12];
    mov.u32 %r4, dynamic; mad.lo.u32 %r4, %lane, 4, %r4; st.shared.u32 [%r4], %lane;
    mov.u32 %r5, fixed; mad.lo.u32 %r5, %lane, 4, %r5; st.shared.u32 [%r5], 1000;
    bar.sync 0;
    ld.shared.u32 %r6, [%r4]; ld.shared.u32 %r7, [%r5];
    add.u32 %out, %r1, %r2; add.u32 %out, %out, %r3; add.u32 %out, %out, %r6; add.u32 %out, %out, %r7;)";
  CHECK(outputs(storing(body, variables), {{1, 1, 1}, {32, 1, 1}, 128}) ==
        expected([](uint32_t lane) { return 1077 + lane; }));
}

TEST_CASE("local memory, vectors, literals and predicates mean what PTX says") {
  const std::string body = R"(
    .local .align 16 .b8 depot[32];
    .reg .v4 .b32 %v; .reg .b16 %h<5>;
    mov.u64 %rd1, depot; cvta.local.u64 %rd2, %rd1;
    st.local.v4.u32 [%rd1], {%lane, 0x10, 020, 0b11};
    ld.v4.u32 {%r1, %r2, %r3, %r4}, [%rd2];
    mov.b32 {%h1, %h2}, 0x00050004; mov.b32 %r5, {%h2, %h1};
    mov.f32 %f1, 1.5; fma.rn.f32 %f1, %f1, 0f40000000, -1.0; cvt.rzi.u32.f32 %r6, %f1;
    setp.lt.and.u32 %p1|%p2, %lane, 4, !%p9;
    add.u32 %out, %r1, %r2; add.u32 %out, %out, %r3; add.u32 %out, %out, %r4; add.u32 %out, %out, %r5; add.u32 %out, %out, %r6;
    @%p1 add.u32 %out, %out, 1000; @%p2 add.u32 %out, %out, 2000;)";
  CHECK(outputs(storing(body)) ==
        expected([](uint32_t lane) { return lane + 16 + 16 + 3 + 0x40005 + 2 + (lane < 4 ? 1000 : 2000); }));
}

TEST_CASE("mistakes are told with file, line and column, all at once") {
  const std::string two = message_of(storing("add.u33 %r1, %r2, %r3;\nfrobnicate.b32 %r1, %r2;"));
  CHECK(two.find("test.ptx:8:1: error: no op 'add.u33'; did you mean 'add.u32'?") != std::string::npos);
  CHECK(two.find("test.ptx:9:1: error: no op 'frobnicate.b32'") != std::string::npos);
  CHECK(message_of(storing("add.u32 %r1, %nothing, 1;"))
            .find("test.ptx:8:14: error: '%nothing' is not declared") != std::string::npos);
  CHECK(message_of(storing("bra NOWHERE;")).find("test.ptx:8:5: error: there is no label 'NOWHERE' here") !=
        std::string::npos);
  CHECK(message_of(storing("add.u32 %r1, %r2;")).find("takes 3 operands, not 2") != std::string::npos);
  CHECK(message_of(storing("add.u32 %r1 %r2;")).find("test.ptx:8:13: error: expected ',', found '%r2'") !=
        std::string::npos);
  CHECK(message_of(storing("@%r1 bra X; X:")).find("'%r1' is not a predicate") != std::string::npos);
  CHECK(message_of(storing("call printf;", ".extern .func printf();\n")).find("has no body") !=
        std::string::npos);
  CHECK(message_of(storing(".local .b8 big[524289];"))
            .find("'big': more than 524288 bytes of local memory of one thread") != std::string::npos);
  CHECK(message_of(kHead).find("the module has no kernel") != std::string::npos);
}

TEST_CASE(
    "parts of PTX that Glint does not have are named as such, and no word of an access is passed over") {
  const auto says = [](const char* line, const char* message) {
    CAPTURE(line);
    CHECK(message_of(storing(line)).find(message) != std::string::npos);
  };
  says("wgmma.wait_group.sync.aligned 0;", "belongs to asynchronous ops of tensor cores");
  says("mov.u32 %r1, %envreg2;", "by which cooperative groups wait for the whole grid");
  says("cp.async.bulk.commit_group;", "'cp.async.bulk.commit_group', which belongs to bulk copies");
  says("st.async.shared::cluster.u32 [%r1], %r2, [%r3];", "belongs to bulk copies");
  says("barrier.cluster.arrive;", "belongs to clusters of more than one block");
  says("vadd4.u32.u32.u32 %r2, %r1.b1, %r1, %r2;",
       "test.ptx:8:24: error: not supported: '%r1.b1', a byte or half");
  says("vadd.u32.u32.u32.sat %r2, %r1.b1, %r1;",
       "test.ptx:8:1: error: not supported: 'vadd.u32.u32.u32.sat' with parts");
  says("vmin.u32.u32.u32.max %r2, %r1, %r1, %r2;", "not supported: 'vmin.u32.u32.u32.max' with parts");
  says("vadd.u32.u32.u32 %r2.h1, %r1, %r1, %r2;", "not supported: 'vadd.u32.u32.u32' with parts");
  says("vmad.u32.u32.u32.shr7 %r2, %r1, %r1, %r2;", "not supported: 'vmad.u32.u32.u32.shr7' with parts");
  says("vset.u32.u32.foo %r2, %r1, %r1;", "no op 'vset.u32.u32.foo'");
  says("ld.global.volatil.u32 %r1, [%d1];", "no op 'ld.global.volatil.u32'");
}

TEST_CASE("the example kernels give the same on both machines, and what they should") {
  const auto read = [](const std::string& name) {
    std::ifstream in(std::string(GLINT_SOURCE_DIR) + "/shaders/kernels/" + name);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  pipeline::GpuParams params;
  params.cores = 2;
  for (const bool timing : {false, true}) {
    std::vector<uint32_t> numbers(1024);
    for (uint32_t i = 0; i < 1024; ++i) numbers[i] = i;
    Launcher sums(read("block_sums.ptx"), "block_sums.ptx", "block_sums");
    sums.buffer(numbers).buffer(std::vector<uint32_t>(4));
    const pipeline::KernelGrid grid{{4, 1, 1}, {256, 1, 1}, 0};
    if (timing)
      CHECK(sums.run_timing(grid, params) > 0);
    else
      sums.run_functional(grid);
    CHECK(sums.read<uint32_t>(1, 4) == std::vector<uint32_t>{32640, 98176, 163712, 229248});

    Launcher saxpy(read("saxpy.ptx"), "saxpy.ptx", "saxpy");
    std::vector<float> x(1000), y(1000, 1.0f), z(1000);
    for (size_t i = 0; i < 1000; ++i) x[i] = float(i), z[i] = 2.0f * float(i) + 1.0f;
    saxpy.buffer(x).buffer(y).value(2.0f).value(1000u);
    const pipeline::KernelGrid lines{{8, 1, 1}, {128, 1, 1}, 0};
    if (timing)
      CHECK(saxpy.run_timing(lines, params) > 0);
    else
      saxpy.run_functional(lines);
    CHECK(saxpy.read<float>(1, 1000) == z);
  }
}
