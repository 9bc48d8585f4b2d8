// Tests what shaping makes of comparisons, products, counted loops and loads.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <string>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

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
