// Tests what the PTX front end does with parts of words, halves of pairs, tests of logic and negations: each
// kernel has the results of the same text without shaping.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <string>
#include <utility>

#include "tests/ptx/one_warp.h"

using namespace glint;

namespace {

// Returns the shaped kernel with hashes of the lane in %r1, %r2 and, of 64 bits, in %rd1 and %rd2.
std::string narrowed(const std::string& body, const std::string& before = "") {
  return shaped(
      ".reg .b16 %rs<9>;\nmul.lo.u32 %r1,%lane,-1640531527;xor.b32 %r2,%r1,29;mul.lo.u32 "
      "%r2,%r2,-2048144777;mul.wide.u32 %rd1,%r1,%r2;mul.wide.u32 %rd2,%r2,%r2;xor.b64 %rd2,%rd2,%rd1;\n" +
          body,
      before);
}
const std::string kFold =
    "shr.u64 %rd9,%rd8,32;cvt.u32.u64 %r8,%rd9;cvt.u32.u64 %r9,%rd8;xor.b32 %out,%r8,%r9;";

}  // namespace

TEST_CASE("logic and the test of its result are one instruction") {
  for (const auto& [test, op] : {std::pair{"eq", "lop3.eq"}, std::pair{"ne", "lop3.ne"}})
    for (const std::string logic : {"and.b32 %r3,%r1,6;", "xor.b32 %r4,%r1,%r2;and.b32 %r3,%r4,12;",
                                    "or.b32 %r4,%r1,%r2;not.b32 %r5,%r4;and.b32 %r3,%r5,%lane;"}) {
      const std::string code =
          narrowed(fmt::format("{}setp.{}.s32 %p1,%r3,0;selp.b32 %out,%r1,%r2,%p1;", logic, test));
      CHECK(count(code, op) == 1);
      CHECK(count(code, "setp") == 0);
    }
  // Others read the result, too; and two tests of one result.
  const std::string both = narrowed(
      "and.b32 %r3,%r1,6;setp.eq.s32 %p1,%r3,0;setp.ne.s32 %p2,%r3,0;selp.b32 %r4,%r1,%r2,%p1;selp.b32 "
      "%r5,%r1,7,%p2;add.u32 %out,%r3,%r4;xor.b32 %out,%out,%r5;");
  CHECK(count(both, "lop3.both") == 1);
  CHECK(count(both, "setp") == 0);
  // The comparison with another number stays, and so does that of a sum.
  CHECK(count(narrowed("and.b32 %r3,%r1,6;setp.eq.s32 %p1,%r3,2;selp.b32 %out,%r1,%r2,%p1;"), "setp.eq") ==
        1);
  CHECK(count(narrowed("add.u32 %r3,%r1,6;setp.eq.s32 %p1,%r3,0;selp.b32 %out,%r1,%r2,%p1;"), "setp.eq") ==
        1);
}

TEST_CASE("the test of logic keeps its own instruction where another comparison can take in its result") {
  const std::string code = narrowed(
      "and.b32 %r3,%r1,6;setp.lt.u32 %p2,%r1,%r2;setp.eq.s32 %p1,%r3,0;and.pred %p3,%p2,%p1;selp.b32 "
      "%out,%r1,%r2,%p3;");
  CHECK(count(code, "lop3.eq") == 1);
  CHECK(count(code, "setp.lt.and") == 1);
}

TEST_CASE("numbers of 16 bits are words where their higher bits are known to be 0") {
  const std::string masked =
      narrowed("cvt.u16.u32 %rs1,%r1;and.b16 %rs2,%rs1,3;setp.eq.s16 %p1,%rs2,1;selp.b32 %out,%r1,%r2,%p1;");
  CHECK(count(masked, "cvt.u16") == 0);
  CHECK(count(masked, "setp.eq.u32") == 1);
  const std::string sums = narrowed(
      "and.b32 %r3,%r1,255;and.b32 %r4,%r2,255;cvt.u16.u32 %rs1,%r3;cvt.u16.u32 %rs2,%r4;add.s16 "
      "%rs3,%rs1,%rs2;shl.b16 %rs4,%rs3,4;shr.u16 %rs5,%rs4,1;mul.lo.s16 %rs6,%rs5,50;cvt.u32.u16 "
      "%out,%rs6;");
  CHECK(count(sums, "16") == 1);  // of the product, which may overflow
  // Higher bits matter here, and the sign does there.
  CHECK(count(narrowed("cvt.u16.u32 %rs1,%r1;setp.eq.s16 %p1,%rs1,1;selp.b32 %out,%r1,%r2,%p1;"), "16") >= 1);
  CHECK(count(narrowed("cvt.u16.u32 %rs1,%r1;cvt.u16.u32 %rs2,%r2;setp.lt.s16 %p1,%rs1,%rs2;selp.b32 "
                       "%out,%r1,%r2,%p1;"),
              "setp.lt.s16") == 1);
  CHECK(count(narrowed("cvt.u16.u32 %rs1,%r1;add.s16 %rs2,%rs1,-48;and.b16 %rs3,%rs2,255;setp.lt.u16 "
                       "%p1,%rs3,100;selp.b32 %out,%r1,%r2,%p1;"),
              "setp.lt.u32") == 1);
}

TEST_CASE("a sum takes in the product of numbers of 16 bits") {
  for (const auto& [type, mask] : {std::pair{"u16", 65535}, std::pair{"s16", 32767}}) {
    const std::string code = narrowed(fmt::format(
        "and.b32 %r3,%r1,{1};cvt.u16.u32 %rs1,%r3;mul.wide.{0} %r4,%rs1,3000;add.u32 %out,%r4,%r2;", type,
        mask));
    CHECK(count(code, "mul.wide") == 0);
    CHECK(count(code, "mad.lo") == 1);
  }
  CHECK(count(narrowed("cvt.u16.u32 %rs1,%r1;mul.wide.s16 %r4,%rs1,3;add.u32 %out,%r4,%r2;"),
              "mul.wide.s16") == 1);
}

TEST_CASE("a part of a word is converted in one instruction") {
  for (const auto& [part, op] : {std::pair{"shr.u32 %r3,%r1,24;", "cvt.rn.f32.u8.b3"},
                                 std::pair{"shr.u32 %r3,%r1,16;", "cvt.rn.f32.u16.h1"},
                                 std::pair{"bfe.u32 %r3,%r1,8,8;", "cvt.rn.f32.u8.b1"},
                                 std::pair{"bfe.u32 %r3,%r1,16,8;", "cvt.rn.f32.u8.b2"}})
    CHECK(count(narrowed(fmt::format("{}cvt.rn.f32.u32 %f1,%r3;mov.b32 %out,%f1;", part)), op) == 1);
  CHECK(count(narrowed("shr.u32 %r3,%r1,23;cvt.rn.f32.u32 %f1,%r3;mov.b32 %out,%f1;"), "shr.u32") == 1);
}

TEST_CASE("two shifts that meet are one, and a pair is rotated where the parts are added") {
  for (const char* join : {"or.b32", "xor.b32", "add.u32"}) {
    const std::string code =
        narrowed(fmt::format("shl.b32 %r3,%r1,7;shr.u32 %r4,%r2,25;{} %out,%r3,%r4;", join));
    CHECK(count(code, "shf.l.wrap") == 1);
    CHECK(count(code, "shl.b32") == 0);
  }
  CHECK(count(narrowed("shl.b32 %r3,%r1,7;shr.u32 %r4,%r2,24;or.b32 %out,%r3,%r4;"), "shf.l") == 0);
  CHECK(count(narrowed("shl.b64 %rd3,%rd1,13;shr.u64 %rd4,%rd1,51;add.u64 %rd8,%rd3,%rd4;" + kFold),
              "rotl.b64") == 1);
  CHECK(count(narrowed("shl.b64 %rd3,%rd1,13;shr.u64 %rd4,%rd1,51;or.b64 %rd8,%rd3,%rd4;" + kFold),
              "rotl.b64") == 0);
  CHECK(count(narrowed("shl.b64 %rd3,%rd1,13;shr.u64 %rd4,%rd2,51;add.u64 %rd8,%rd3,%rd4;" + kFold),
              "rotl.b64") == 0);
}

TEST_CASE("halves of pairs that are known take no instruction") {
  const std::string mixed = narrowed("shr.u64 %rd3,%rd1,33;xor.b64 %rd8,%rd3,%rd1;" + kFold);
  CHECK(count(mixed, "shr.half.u64") == 1);
  CHECK(count(mixed, "xor.half.b64") == 1);
  CHECK(count(mixed, "cvt.u32.u64") == 0);
  CHECK(count(narrowed("shr.u64 %rd3,%rd1,30;xor.b64 %rd8,%rd3,%rd1;" + kFold), "half") == 0);
  CHECK(count(narrowed("shl.b64 %rd3,%rd1,40;or.b64 %rd8,%rd3,%rd2;" + kFold), ".half") == 2);
  CHECK(count(narrowed("and.b64 %rd8,%rd1,-8;" + kFold), "and.half") == 1);
  CHECK(count(narrowed("and.b64 %rd8,%rd1,-4294967304;" + kFold), "and.half") == 0);
  CHECK(count(narrowed("shr.u64 %rd3,%rd1,9;cvt.u32.u64 %out,%rd3;"), "shr.low.u64") == 1);
  const std::string pair = narrowed(
      "cvt.u64.u32 %rd3,%r1;cvt.u64.u32 %rd4,%r2;shl.b64 %rd5,%rd4,32;or.b64 %rd8,%rd5,%rd3;add.s64 "
      "%rd8,%rd8,%rd1;" +
      kFold);
  CHECK(count(pair, "shl.b64") == 0);
  CHECK(count(narrowed("cvt.u64.u32 %rd3,%r1;cvt.u64.u32 %rd4,%r2;mul.lo.s64 %rd5,%rd3,%rd4;add.s64 "
                       "%rd8,%rd5,%rd2;" +
                       kFold),
              "mul.lo") == 2);  // of the hash
}

TEST_CASE("bytes of a vector are picked out of words") {
  const std::string bytes = ".global .align 8 .b8 bytes[8] = {1, 130, 3, 255, 5, 6, 7, 200};\n";
  for (const auto& [type, parts] : {std::pair{"u8", 4}, std::pair{"s8", 4}, std::pair{"u16", 4},
                                    std::pair{"s16", 2}, std::pair{"s8", 2}}) {
    std::string list = "%rs1", sum = "cvt.s32.s16 %r3,%rs1;add.u32 %out,%out,%r3;";
    for (int i = 2; i <= parts; ++i) {
      list += fmt::format(",%rs{}", i);
      sum += fmt::format("cvt.s32.s16 %r3,%rs{};mad.lo.u32 %out,%out,31,%r3;", i);
    }
    const std::string code =
        narrowed(fmt::format("ld.global.v{}.{} {{{}}},[bytes];{}", parts, type, list, sum), bytes);
    CHECK(count(code, "prmt.b32") == size_t(parts));
  }
}

TEST_CASE("an address takes a constant into the displacement while its base holds the same") {
  const std::string table = ".global .align 8 .b32 numbers[40];\n";
  const std::string code = narrowed(
      "mov.u64 %rd5,numbers;cvta.to.global.u64 %rd5,%rd5;mov.u32 %r3,0;\nLOOP: .pragma \"nounroll\";add.s64 "
      "%rd6,%rd5,8;ld.global.u32 %r4,[%rd6+4];add.s64 %rd5,%rd5,4;add.u32 %out,%out,%r4;add.u32 "
      "%r3,%r3,1;setp.lt.u32 %p1,%r3,9;@%p1 bra LOOP;\n",
      table);
  CHECK(count(code, "+ 12]") == 1);
  narrowed(
      "mov.u64 %rd5,numbers;cvta.to.global.u64 %rd5,%rd5;mov.u32 %r3,0;\nLOOP: .pragma \"nounroll\";add.s64 "
      "%rd6,%rd5,8;add.s64 %rd5,%rd5,4;ld.global.u32 %r4,[%rd6+4];add.u32 %out,%out,%r4;add.u32 "
      "%r3,%r3,1;setp.lt.u32 %p1,%r3,9;@%p1 bra LOOP;\n",
      table);
  const std::string byte = narrowed(
      "mov.u64 %rd5,numbers;cvta.to.global.u64 %rd5,%rd5;cvt.s64.s32 %rd6,%lane;add.s64 "
      "%rd7,%rd6,%rd5;ld.global.u8 "
      "%r4,[%rd7];add.u32 %out,%r4,1;",
      table);
  CHECK(count(byte, "add.wide.s32") == 1);
}

TEST_CASE("negations are part of what reads them") {
  const std::string floats =
      "cvt.rn.f32.s32 %f1,%r1;cvt.rn.f32.s32 %f2,%r2;cvt.rn.f32.u32 %f3,%lane;neg.f32 %f4,%f1;";
  for (const auto& [body, op] :
       {std::pair{"mul.f32 %f5,%f4,%f2;", "nmul.rn.f32"}, std::pair{"add.rn.f32 %f5,%f4,%f2;", "sub.rn.f32"},
        std::pair{"sub.rn.f32 %f5,%f2,%f4;", "add.rn.f32"},
        std::pair{"fma.rn.f32 %f5,%f2,%f4,%f3;", "nfma.rn.f32"},
        std::pair{"fma.rn.f32 %f5,%f2,%f3,%f4;", "fms.rn.f32"}}) {
    const std::string code = narrowed(floats + body + "mov.b32 %out,%f5;");
    CHECK(count(code, op) == 1);
    CHECK(count(code, "neg.f32") == 0);
  }
  CHECK(count(narrowed(floats + "sub.rn.f32 %f5,%f4,%f2;mov.b32 %out,%f5;"), "neg.f32") == 1);
}

TEST_CASE("a field is inserted by a shift and logic where its place is constant") {
  for (const auto& [at, size] : {std::pair{5, 7}, std::pair{0, 16}, std::pair{24, 8}, std::pair{31, 1}}) {
    const std::string code = narrowed(fmt::format("bfi.b32 %out,%r1,%r2,{},{};", at, size));
    CHECK(count(code, "bfi") == 0);
    CHECK(count(code, "shl.b32") == (at != 0 ? 1 : 0));
  }
  CHECK(count(narrowed("bfi.b32 %out,%r1,%r2,28,8;"), "bfi") == 1);
  CHECK(count(narrowed("bfi.b32 %out,%r1,%r2,%lane,8;"), "bfi") == 1);
}

TEST_CASE("the least and the largest of three words are one instruction") {
  for (const char* op : {"min.s32", "max.s32", "min.u32", "max.u32"}) {
    const std::string code = narrowed(fmt::format("{0} %r3,%r1,%r2;{0} %out,%lane,%r3;", op));
    CHECK(count(code, std::string(op).replace(3, 0, "3")) == 1);
  }
  CHECK(count(narrowed("min.s32 %r3,%r1,%r2;max.s32 %out,%lane,%r3;"), "3.s32") == 0);
}
