// Tests the PTX front end by small kernels: what they compute, and how mistakes are reported.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "isa/text.h"
#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

std::string message_of(const std::string& text) {
  try {
    frontend::compile_ptx(text, "test.ptx", "", {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::vector<uint32_t> expected(uint32_t (*of_lane)(uint32_t)) {
  std::vector<uint32_t> out;
  for (uint32_t lane = 0; lane < 32; ++lane) out.push_back(of_lane(lane));
  return out;
}

}  // namespace

TEST_CASE("lanes that part meet again where their paths must meet") {
  // Half of the lanes take each side, and inside one side some take another branch. The vote after it sees
  // all lanes.
  const std::string body = R"(
    setp.lt.u32 %p1, %lane, 16;
    @%p1 bra LOW;
    setp.lt.u32 %p2, %lane, 24;
    @%p2 bra MIDDLE;
    mov.u32 %r1, 3;
    bra INNER;
  MIDDLE: mov.u32 %r1, 2;
  INNER: activemask.b32 %r2;
    bra ALL;
  LOW: mov.u32 %r1, 1;
    mov.u32 %r2, 7;
  ALL: activemask.b32 %r3;
    mad.lo.u32 %out, %r1, 100, %r2;
    setp.ne.u32 %p3, %r3, -1;
    @%p3 mov.u32 %out, 9;)";
  CHECK(outputs(storing(body)) ==
        expected([](uint32_t lane) { return lane < 16 ? 107u : (lane < 24 ? 200u : 300u) + 0xffff0000u; }));
}

TEST_CASE("a loop with several exits and an early end gathers the lanes that are left") {
  const std::string body = R"(
    mov.u32 %r1, 0;
  LOOP: add.u32 %r1, %r1, 1;
    setp.eq.u32 %p1, %r1, %lane;
    @%p1 bra FOUND;
    setp.gt.u32 %p2, %r1, 40;
    @%p2 bra NOWHERE;
    setp.eq.u32 %p3, %lane, 5;
    @%p3 exit;
    bra LOOP;
  NOWHERE: mov.u32 %r1, 77;
  FOUND: activemask.b32 %r2;
    add.u32 %out, %r1, 1000;
    setp.ne.u32 %p4, %r2, 0xffffffdf;
    @%p4 mov.u32 %out, 9;)";
  CHECK(outputs(storing(body)) == expected([](uint32_t lane) {
          return lane == 5 ? 0u : lane == 0 ? 1077u : lane + 1000;
        }));
}

TEST_CASE("functions take and give words, bytes and structs, and become part of each caller") {
  const std::string functions = R"(
  .func (.param .b32 r) twice(.param .b32 v)
  { .reg .b32 %a; ld.param.u32 %a, [v]; shl.b32 %a, %a, 1; st.param.b32 [r], %a; ret; }
  .func (.param .align 8 .b8 r[16]) pick(.param .align 4 .b8 s[8], .param .b32 n)
  { .reg .b32 %a, %b, %n; .reg .b64 %w; .reg .pred %p; .reg .b16 %h;
    ld.param.u32 %a, [s]; ld.param.s16 %h, [s+4]; cvt.s32.s16 %b, %h; ld.param.u32 %n, [n];
    setp.gt.u32 %p, %n, 20;
    @%p bra BIG;
    cvt.s64.s32 %w, %b; st.param.b64 [r], %w; st.param.b32 [r+8], %a; ret;
  BIG: { .param .b32 x; .param .b32 y; st.param.b32 [x], %a; call.uni (y), twice, (x); ld.param.b32 %a, [y]; }
    mov.u64 %w, 5; st.param.b64 [r], %w; st.param.b32 [r+8], %a; ret; })";
  const std::string body = R"(
    { .param .align 4 .b8 s[8]; .param .b32 n; .param .align 8 .b8 r[16];
      st.param.b32 [s], 300; st.param.b16 [s+4], 0xfffe; st.param.b32 [n], %lane;
      call (r), pick, (s, n);
      ld.param.b64 %rd1, [r]; ld.param.b32 %r1, [r+8]; }
    cvt.u32.u64 %r2, %rd1; add.u32 %out, %r1, %r2;)";
  CHECK(outputs(storing(body, functions)) == expected([](uint32_t lane) { return lane > 20 ? 605u : 298u; }));
}

TEST_CASE("an indexed branch goes to the label of each lane's index") {
  const std::string body = R"(
    rem.u32 %r1, %lane, 3;
    brx.idx %r1, TABLE;
    TABLE: .branchtargets A, B, C;
  A: mov.u32 %out, 10; bra END;
  B: mov.u32 %out, 11; bra END;
  C: mov.u32 %out, 12;
  END: activemask.b32 %r2; setp.ne.u32 %p1, %r2, -1; @%p1 mov.u32 %out, 9;)";
  CHECK(outputs(storing(body)) == expected([](uint32_t lane) { return 10 + lane % 3; }));
}

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

TEST_CASE("a comparison takes in the predicate that it is combined with, unless others read it alone") {
  const std::string both =
      "setp.gt.u32 %p1,%lane,3;setp.lt.u32 %p2,%lane,20;and.pred %p3,%p1,%p2;setp.eq.u32 "
      "%p4,%lane,30;or.pred %p5,%p4,%p3;\n@%p5 mov.u32 %out,7;\n";
  const std::string text = shaped(both);
  CHECK(count(text, "setp.lt.and.u32") + count(text, "setp.gt.and.u32") == 1);
  CHECK(count(text, "setp.eq.or.u32") == 1);
  CHECK(count(text, ".pred") == 0);
  CHECK(count(shaped(both + "@%p1 add.u32 %out,%out,1;@%p2 add.u32 %out,%out,2;\n"), "and.pred") == 1);
  // The register that the comparison reads has changed since.
  CHECK(count(shaped("mov.u32 %r1,%lane;setp.gt.u32 %p1,%r1,3;setp.ne.u32 %p2,%lane,9;add.u32 "
                     "%r1,%r1,%lane;and.pred %p3,%p1,%p2;\n"
                     "@%p1 add.u32 %out,%out,1;\n@%p3 add.u32 %out,%out,%r1;\n"),
              "setp.gt.and") == 0);
}

TEST_CASE("a product that only sums read becomes part of each of them") {
  const std::string body =
      "mul.lo.u32 %r9,%lane,7;mul.wide.u32 %rd1,%r9,12;cvt.u64.u32 %rd4,%lane;add.s64 %rd2,%rd1,%rd4;add.s64 "
      "%rd3,%rd2,%rd1;xor.b64 %rd5,%rd2,%rd3;cvt.u32.u64 %out,%rd5;\n";
  const std::string text = shaped(body);
  CHECK(count(text, "mad.wide.u32") == 3);  // one of them for the address of the store
  CHECK(count(text, "mul.wide.u32") == 0);
  const std::string read = shaped(body + "cvt.u32.u64 %r5,%rd1;add.u32 %out,%out,%r5;\n");
  CHECK(count(read, "mul.wide.u32") == 1);
  CHECK(count(shaped("shl.b32 %r1,%lane,5;add.s32 %r2,%r1,3;add.s32 %r3,%r1,%lane;xor.b32 %out,%r2,%r3;\n"),
              "shl.b32") == 0);
}

TEST_CASE("a loop of one block that counts down runs four turns at a time, and any number of them") {
  // Lanes count from different multiples of 3. The pointer steps by 8, and the value that it is added to
  // stays.
  const auto body = [](const std::string& start, const std::string& more = "") {
    return "mul.lo.u32 %r1,%lane,3;" + start +
           "mov.u64 %rd1,0;mul.wide.u32 %rd2,%lane,16;mov.u32 %r2,7;\n"
           "LOOP: add.s64 %rd3,%rd1,%rd2;cvt.u32.u64 %r3,%rd3;add.s64 %rd1,%rd1,8;add.s64 "
           "%rd4,%rd1,%rd2;cvt.u32.u64 %r4,%rd4;\n"
           "mad.lo.u32 %r2,%r2,5,%r3;xor.b32 %r2,%r2,%r4;" +
           more +
           "add.s32 %r1,%r1,-3;setp.ne.s32 %p1,%r1,0;@%p1 bra LOOP;\n"
           "cvt.u32.u64 %r5,%rd1;add.u32 %out,%r2,%r5;add.u32 %out,%out,%r1;\n";
  };
  const std::string some = shaped(body("add.u32 %r1,%r1,3;"));
  CHECK(count(some, "mad.lo.u32 %r") >= 5);
  CHECK(count(some, "setp.gt.s32") == 4);  // for four and for two turns, each before and after
  shaped(body("mov.u32 %r1,12;"));
  shaped(body("mov.u32 %r1,15;"));
  // The loop is not unrolled where lanes read each other, or where the predicate that ends it is read later.
  CHECK(count(shaped(body("mov.u32 %r1,30;", "shfl.sync.bfly.b32 %r2,%r2,1,31,-1;")), "setp.gt.s32") == 0);
  CHECK(count(shaped(body("mov.u32 %r1,30;") + "@%p1 add.u32 %out,%out,1;\n"), "setp.gt.s32") == 0);
}

TEST_CASE(
    "a loop of one block that counts up to a bound runs four turns at a time, and any number of them, also "
    "where the bound less four turns has no name") {
  // The loop counts %r1 from `start` by 3 up to `bound`; %r2 shows the turns of each lane.
  const auto body = [](const std::string& start, const std::string& bound, const std::string& more = "") {
    return start + bound + "mov.u32 %r2,7;\nLOOP: mad.lo.u32 %r2,%r2,5,%r1;" + more +
           "add.s32 %r1,%r1,3;setp.lt.s32 %p1,%r1,%r6;@%p1 bra LOOP;\nadd.u32 %out,%r2,%r1;\n";
  };
  const std::string by_lane = "mov.u32 %r6,%lane;", from_2 = "mov.u32 %r1,2;";
  for (const std::string& text :
       {shaped(body(from_2, by_lane)), shaped(body("mov.u32 %r1,%lane;", "mov.u32 %r6,40;"))}) {
    CHECK(count(text, "mad.lo.u32 %r") >= 7);
    CHECK(count(text, "setp.lt.s32") == 6);  // for 4, 4, 2, 2 and 1 turns, and for the loop itself
  }
  for (const char* start : {"mov.u32 %r1,-2147483648;", "mov.u32 %r1,2147483640;", "mov.u32 %r1,0;"})
    shaped(body(start, "add.u32 %r6,%lane,-2147483648;"));
  // A loop that waits for the block is unrolled only where all lanes count alike.
  const std::string waits = "bar.sync 0;";
  CHECK(count(shaped(body(from_2, "mov.u32 %r6,%ntid.x;", waits)), "setp.lt.s32") == 6);
  CHECK(count(shaped(body(from_2, "shr.u32 %r6,%lane,5;add.u32 %r6,%r6,40;", waits)), "setp.lt.s32") == 1);
  CHECK(count(shaped(body("shr.u32 %r1,%lane,5;", "mov.u32 %r6,%ntid.x;", waits)), "setp.lt.s32") == 1);
}

TEST_CASE("a loop that counts up to an unsigned bound runs four turns at a time, and any number of them") {
  // %r2 shows the turns of each lane.
  const auto words = [](const std::string& start, const std::string& bound) {
    return "mov.u32 %r1," + start + ";" + bound +
           "mov.u32 %r2,7;\nLOOP: mad.lo.u32 %r2,%r2,5,%r1;add.u32 %r1,%r1,3;setp.lt.u32 %p1,%r1,%r6;@%p1 "
           "bra "
           "LOOP;\nadd.u32 %out,%r2,%r1;\n";
  };
  const auto pairs = [](const std::string& start, const std::string& bound) {
    return "mov.u64 %rd1," + start + ";" + bound +
           "mov.u32 %r2,7;\nLOOP: cvt.u32.u64 %r1,%rd1;mad.lo.u32 %r2,%r2,5,%r1;add.u64 "
           "%rd1,%rd1,3;setp.lt.u64 "
           "%p1,%rd1,%rd6;@%p1 bra LOOP;\nadd.u32 %out,%r2,%r1;\n";
  };
  const std::string by_lane = "mov.u32 %r6,%lane;";
  const std::string text = shaped(words("2", by_lane));
  CHECK(count(text, "mad.lo.u32 %r") >= 7);
  CHECK(count(text, "setp.lt.u32") == 6);  // for 4, 4, 2, 2 and 1 turns, and for the loop itself
  CHECK(count(shaped(words("%lane", "mov.u32 %r6,40;")), "setp.lt.u32") == 6);
  shaped(words("%lane", "mov.u32 %r6,5;"));  // The bound is below four turns.
  shaped(words("4294967280", by_lane));
  shaped(words("2147483600", "add.u32 %r6,%lane,2147483640;"));
  shaped(words("4294967200", "sub.u32 %r6,4294967290,%lane;"));
  CHECK(count(shaped(pairs("2", "cvt.u64.u32 %rd6,%lane;")), "setp.lt.u64") == 6);
  shaped(pairs("4294967290", "cvt.u64.u32 %rd6,%lane;add.u64 %rd6,%rd6,4294967296;"));
  shaped(pairs("-9223372036854775808", "cvt.u64.u32 %rd6,%lane;add.u64 %rd6,%rd6,-9223372036854775800;"));
}

TEST_CASE("the negation of a product is part of what reads it, to the bit") {
  const std::string text = shaped(
      "cvt.rn.f32.u32 %f6,%lane;sub.rn.f32 %f1,%f6,0f40A00000;mov.u32 %r1,0;mov.u32 %r2,0;\n"
      "LOOP: .pragma \"nounroll\";cvt.rn.f32.u32 %f7,%r1;sub.rn.f32 %f2,%f7,0f40000000;mul.f32 "
      "%f3,%f1,%f2;neg.f32 "
      "%f4,%f3;add.rn.f32 %f5,%f4,%f2;mov.b32 %r3,%f5;\n"
      "mad.lo.u32 %r2,%r2,31,%r3;add.u32 %r1,%r1,1;setp.lt.u32 %p1,%r1,5;@%p1 bra LOOP;\nmov.u32 "
      "%out,%r2;\n");
  CHECK(count(text, "neg.f32") == 0);
}

TEST_CASE("words of shared memory are loaded together where their place is known to be aligned") {
  const std::string room = ".shared .align 16 .b8 room[4096];\n";
  const auto body = [](int stride, const std::string& between = "") {
    return fmt::format(
        "mov.u32 %r1,room;shl.b32 %r2,%lane,{};add.s32 %r3,%r1,%r2;st.shared.u32 [%r3],%lane;st.shared.u32 "
        "[%r3+12],5;bar.sync 0;\n"
        "ld.shared.u32 %r4,[%r3];ld.shared.u32 %r5,[%r3+12];{}ld.shared.u32 %r6,[%r3+4];ld.shared.u32 "
        "%r7,[%r3+8];\n"
        "mad.lo.u32 %out,%r4,3,%r5;mad.lo.u32 %out,%r6,5,%out;mad.lo.u32 %out,%r7,7,%out;\n",
        stride, between);
  };
  CHECK(count(shaped(body(4), room), "ld.shared.v4") == 1);
  CHECK(count(shaped(body(4), room), "ld.shared.b32") == 0);
  CHECK(count(shaped(body(3), room), "ld.shared.v4") == 0);
  CHECK(count(shaped(body(3), room), "ld.shared.v2") == 2);
  CHECK(count(shaped(body(2), room), "ld.shared.v") == 0);
  CHECK(count(shaped(body(4, "st.shared.u32 [%r3+8],9;"), room), "ld.shared.v4") == 0);
}

TEST_CASE("lanes that branch to the end of the kernel end where they are") {
  const std::string text = kHead +
                           ".visible .entry k(.param .u64 to)\n{\n.reg .b32 %lane; .reg .b64 %at; .reg .pred "
                           "%p;\nmov.u32 %lane, %tid.x;\n"
                           "setp.gt.u32 %p, %lane, 4;\n@%p bra END;\nld.param.u64 %at, [to]; mad.wide.u32 "
                           "%at, %lane, 4, %at; st.global.u32 [%at], 1;\nEND: ret;\n}\n";
  const std::string code = isa::to_text(frontend::compile_ptx(text, "test.ptx", "k", {}).program);
  CHECK(count(code, "%p0 exit") == 1);
  CHECK(count(code, "ssy") + count(code, "join") + count(code, "bra") == 0);
  CHECK(outputs(text) == expected([](uint32_t lane) { return uint32_t(lane <= 4); }));
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
  CHECK(message_of(storing("call f;", ".func f() { call f; ret; }\n")).find("'f' calls itself") !=
        std::string::npos);
  CHECK(message_of(storing("call printf;", ".extern .func printf();\n")).find("has no body") !=
        std::string::npos);
  CHECK(message_of(storing(".local .b8 big[524289];"))
            .find("'big': more than 524288 bytes of local memory of one thread") != std::string::npos);
  CHECK(message_of(kHead).find("the module has no kernel") != std::string::npos);
}

TEST_CASE("video instructions take parts of registers, add a third number, and write a part of it") {
  // Each lane has the bytes b3 = 0x80 + lane, b2 = 3, b1 = 255 - lane, b0 = lane in %r1, and 40 - lane in
  // %r2.
  const std::string before =
      "shl.b32 %r3, %lane, 24; "
      "add.u32 %r1, %lane, 0x8003ff00; add.u32 %r1, %r1, %r3; shl.b32 %r3, %lane, 8; sub.u32 %r1, %r1, %r3; "
      "sub.u32 %r2, 40, %lane;\n";
  const auto check = [&](const char* line, uint32_t (*of_lane)(uint32_t)) {
    CAPTURE(line);
    CHECK(outputs(storing(before + line)) == expected(of_lane));
  };
  check("vadd.u32.u32.u32 %out, %r1.b1, %r1.b0;", [](uint32_t) { return 255u; });
  check("vsub.s32.s32.u32 %out, %r1.b3, %r1.b2;",
        [](uint32_t lane) { return uint32_t(int32_t(lane) - 128 - 3); });
  check("vmax.u32.u32.s32 %out, %r1.b0, %r1.h1;", [](uint32_t lane) { return lane; });
  check("vabsdiff.u32.u32.u32.add %out, %r1.b1, %r2, %lane;",
        [](uint32_t lane) { return 255 - lane - (40 - lane) + lane; });
  check("vmin.u32.u32.u32 %out.b2, %r1.b2, %r2, 0x01020304;", [](uint32_t) { return 0x01030304u; });
  check("vadd.s32.u32.u32 %out.h0, %r1.h0, %r2.b0, %r1;", [](uint32_t lane) {
    return (0x80 + lane) << 24 | 0x3'0000 | (((0xff00 - 256 * lane + lane) + 40 - lane) & 0xffff);
  });
  check("vset.s32.u32.lt %out, %r1.b3, %r2;", [](uint32_t) { return 1u; });
  check("vset.s32.u32.gt.add %out, %r1, %r2, 7;", [](uint32_t) { return 7u; });
  check("vset.u32.u32.ge %out, %r2, 30;", [](uint32_t lane) { return uint32_t(40 - lane >= 30); });
  check("vshl.u32.u32.u32.clamp %out, %r1.b2, %r2;",
        [](uint32_t lane) { return lane > 8 ? 3u << (40 - lane) : 0; });
  check("vshl.u32.u32.u32.wrap %out, %r1.b2, %r2;", [](uint32_t lane) { return 3u << ((40 - lane) & 31); });
  check("vshr.s32.s32.u32.clamp %out, %r1.b3, %r2;",
        [](uint32_t lane) { return uint32_t((int32_t(lane) - 128) >> std::min(31u, 40 - lane)); });
  check("vshr.u32.u32.u32.wrap.add %out, %r1, %r2, 1;", [](uint32_t lane) {
    const uint32_t r1 = (0x80 + lane) << 24 | 0x3'0000 | (0xff - lane) << 8 | lane;
    return (r1 >> ((40 - lane) & 31)) + 1;
  });
  check("vmad.s32.s32.u32 %out, %r1.b3, %r2.b0, %lane;",
        [](uint32_t lane) { return uint32_t((int32_t(lane) - 128) * int32_t(40 - lane) + int32_t(lane)); });
  check("vmad.u32.u32.u32.po %out, %r1.b1, %r1.b2, %r2;",
        [](uint32_t lane) { return (255 - lane) * 3 + 40 - lane + 1; });
  check("setp.lt.u32 %p1, %lane, 9; @%p1 vadd.u32.u32.u32.add %out, %r1.b0, 1, 1;",
        [](uint32_t lane) { return lane < 9 ? lane + 2 : 0; });
}

TEST_CASE("a register or number whose type does not fit is refused, as the assembler of an H200 refuses it") {
  // Each line was given to the driver of an H200, which took the first ones and refused the others.
  const std::string registers =
      ".reg .u16 %h<4>; .reg .f16 %e<4>; .reg .f16x2 %ee<4>; .reg .u32 %u<4>; .reg .s32 %s<4>; .reg .u64 "
      "%l<4>; "
      ".reg .f64 %d<4>; .shared .align 16 .b8 sh[64];\n";
  for (const char* line : {"add.u32 %u1, %s1, %r1",
                           "add.u32 %u1, %ee1, %u2",
                           "add.f32 %f1, %r1, %f2",
                           "add.f64 %d1, %rd1, %d2",
                           "mad.wide.u32 %l1, %u1, %r1, %rd1",
                           "and.b32 %f1, %u1, %s1",
                           "shl.b32 %f1, %f2, %s1",
                           "mov.b32 %r1, %f1",
                           "mov.b32 %r1, 0f3F800000",
                           "selp.f32 %f1, %r1, %f2, %p1",
                           "selp.f32 %f1, 1.0, %f2, %p1",
                           "setp.eq.b32 %p1, %f1, %u1",
                           "ld.shared.b32 %f1, [sh]",
                           "ld.shared.u32 %l1, [sh]",
                           "ld.shared.f32 %rd1, [sh]",
                           "ld.shared.b32 %d1, [sh]",
                           "ld.shared.u8 %h1, [sh]",
                           "st.shared.b16 [sh], %d1",
                           "cvt.rzi.s32.f32 %l1, %rd1",
                           "cvt.f32.f16 %f1, %rd1",
                           "atom.shared.cas.b32 %r1, [sh], %f1, %u1",
                           "sad.u32 %u1, %s1, %r1, %u2",
                           "bfe.u32 %u1, %s1, %r1, %s2",
                           "set.lt.u32.f32 %s1, %f1, %r1",
                           "mov.u32 %u1, %tid.x"}) {
    CAPTURE(line);
    CHECK(message_of(storing(registers + line + ";")) == "no error");
  }
  for (const char* line : {"add.u32 %u1, %u2, %f1",
                           "add.u32 %f1, %u1, %u2",
                           "add.u32 %u1, %rd1, %u2",
                           "add.f32 %f1, %u1, %f2",
                           "add.f32 %d1, %f1, %f2",
                           "add.u16 %u1, %h1, %h2",
                           "add.f16 %e1, %h1, %e2",
                           "mad.wide.u32 %u1, %u2, %u3, %l1",
                           "mad.wide.u32 %l1, %l2, %u3, %l1",
                           "and.b32 %r1, %rd1, %r2",
                           "shl.b32 %r1, %r2, %f1",
                           "mov.u32 %u1, %f1",
                           "mov.f32 %f1, %u1",
                           "selp.u32 %u1, %f1, %u2, %p1",
                           "setp.lt.f32 %p1, %f1, %u1",
                           "ld.shared.u32 %f1, [sh]",
                           "ld.shared.u32 %h1, [sh]",
                           "ld.shared.f32 %d1, [sh]",
                           "ld.shared.f32 %l1, [sh]",
                           "ld.shared.b32 %h1, [sh]",
                           "ld.shared.v2.u32 {%u1, %f1}, [sh]",
                           "st.shared.u32 [sh], %f1",
                           "cvt.rzi.s32.f32 %h1, %f1",
                           "atom.shared.add.u32 %u1, [sh], %l1",
                           "bfe.u32 %u1, %u2, %f1, %u3",
                           "set.lt.u32.f32 %u1, %u2, %f1",
                           "prmt.b32 %r1, %r2, %rd1, %r3",
                           "add.u32 %u1, %u2, 1.0",
                           "mov.u32 %u1, 0f3F800000",
                           "add.f32 %f1, %f2, 1",
                           "mov.f32 %f1, 1",
                           "mov.f64 %d1, 1",
                           "setp.lt.f32 %p1, %f1, 0",
                           "st.shared.f32 [sh], 1"}) {
    CAPTURE(line);
    const std::string message = message_of(storing(registers + line + ";"));
    CHECK(message.find("test.ptx:9:") == 0);
    CHECK(message.find(" here") != std::string::npos);
  }
  CHECK_THAT(
      message_of(storing("add.u32 %r1, %r2, %f1;")),
      Catch::Contains("test.ptx:8:19: error: '%f1' is a register of type .f32, which 'add.u32' does not take "
                      "here") &&
          Catch::Contains("note: it takes .b32, .u32 or .s32; cvt converts a number, and mov.b32 moves its "
                          "bits"));
  CHECK_THAT(
      message_of(storing("mov.f32 %f1, 1;")),
      Catch::Contains("test.ptx:8:14: error: 'mov.f32' takes a number with a point or the bits of one"));
}

TEST_CASE(
    "parts of PTX that Glint does not have are named as such, and no word of an access is passed over") {
  const auto says = [](const char* line, const char* message) {
    CAPTURE(line);
    CHECK(message_of(storing(line)).find(message) != std::string::npos);
  };
  says("tex.2d.v4.f32.f32 {%f1,%f2,%f3,%f4}, [%d1,{%f1,%f2}];", "which belongs to textures and surfaces");
  says("mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32 %r1,%r2,%r3,%r1;",
       "belongs to ops of tensor cores");
  says("cp.async.commit_group;", "'cp.async.commit_group', which belongs to asynchronous copies");
  says("st.async.shared::cluster.u32 [%r1], %r2, [%r3];", "belongs to asynchronous copies");
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
  CHECK(message_of(storing("call vprintf;", ".extern .func vprintf();\n"))
            .find("leave printf and assert out") != std::string::npos);
}

namespace {

// Uses xorshift64*, which gives the same graphs on every machine.
struct Random {
  uint64_t state;
  uint32_t below(uint32_t n) {
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return uint32_t((state * 0x2545'f491'4f6c'dd1dull) >> 33) % n;
  }
};

// Holds a graph of blocks in which any block may lead to any other. Block b adds its number to a hash. Then
// it ends the lane, goes on, or branches by a bit of the hash. A limit on steps ends every walk.
struct Maze {
  struct Block {
    uint32_t kind = 0, bit = 0, taken = 0, next = 0;  // kind 0 ends the lane
  };
  std::vector<Block> blocks;

  explicit Maze(uint64_t seed) {
    Random random{seed * 0x9e37'79b9'7f4a'7c15ull + 1};
    const uint32_t count = 2 + random.below(10);
    for (uint32_t b = 0; b < count; ++b) {
      const uint32_t kind = random.below(8);
      blocks.push_back({kind == 0  ? 0u
                        : kind < 3 ? 1u
                                   : 2u,
                        random.below(12), random.below(count), random.below(count)});
    }
    blocks.back().kind = 0;
  }
  uint32_t walk(uint32_t lane) const {
    uint32_t hash = lane * 2654435761u, steps = 0, at = 0;
    while (true) {
      hash = (hash ^ (at + 1)) * 16777619u;
      if (++steps > 60 || blocks[at].kind == 0) return hash;
      const bool taken = blocks[at].kind == 2 && (hash >> (8 + blocks[at].bit) & 1);
      at = taken ? blocks[at].taken : blocks[at].next;
    }
  }
  std::string text() const {
    std::string out = "mul.lo.u32 %out, %lane, 2654435761; mov.u32 %r1, 0;\n";
    for (size_t b = 0; b < blocks.size(); ++b) {
      out += fmt::format(
          "B{}: xor.b32 %out, %out, {}; mul.lo.u32 %out, %out, 16777619; add.u32 %r1, %r1, 1;\n"
          "setp.gt.u32 %p1, %r1, 60; @%p1 bra END;\n",
          b, b + 1);
      if (blocks[b].kind == 0) out += "bra END;\n";
      if (blocks[b].kind == 2)
        out += fmt::format(
            "shr.u32 %r2, %out, {}; and.b32 %r2, %r2, 1; setp.ne.u32 %p2, %r2, 0; @%p2 bra B{};\n",
            8 + blocks[b].bit, blocks[b].taken);
      if (blocks[b].kind != 0) out += fmt::format("bra B{};\n", blocks[b].next);
    }
    return out + "END: activemask.b32 %r3; setp.ne.u32 %p3, %r3, -1; @%p3 mov.u32 %out, 0;\n";
  }
};

}  // namespace

TEST_CASE("in any graph of branches each lane walks its own way, and all meet at the end") {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    const Maze maze(seed);
    INFO("seed " << seed << "\n" << maze.text());
    const std::vector<uint32_t> got = outputs(storing(maze.text()));
    std::vector<uint32_t> walked;
    for (uint32_t lane = 0; lane < 32; ++lane) walked.push_back(maze.walk(lane));
    REQUIRE(got == walked);
  }
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
