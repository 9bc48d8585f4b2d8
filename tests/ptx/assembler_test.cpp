// Tests loops whose turns are known, selections under guards and edges into selections: kernels have the
// results of the same text without shaping, and the shape of the hardware assembler's code.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <string>
#include <utility>

#include "tests/ptx/one_warp.h"

using namespace glint;

namespace {

// Returns a loop that counts %r1 from `start` by `step` while `test` holds; %r2 shows the turns, %r3 a
// stepping register that starts as a constant.
std::string counting(const std::string& start, int step, const std::string& test,
                     const std::string& turn = "") {
  return fmt::format(
      "mov.u32 %r1,{};mov.u32 %r3,100;mov.u32 %r2,%lane;\nLOOP: {}mad.lo.u32 %r2,%r2,5,%r1;xor.b32 "
      "%r2,%r2,%r3;"
      "add.s32 %r3,%r3,7;add.s32 %r1,%r1,{};setp.{} %p1,%r1,{};@%p1 bra LOOP;\nadd.u32 %out,%r2,%r1;add.u32 "
      "%out,%out,%r3;\n",
      start, turn, step, test.substr(0, test.find(' ')), test.substr(test.find(' ') + 1));
}

}  // namespace

TEST_CASE("a loop whose number of turns is a constant becomes one run, in which the counter is a constant") {
  for (const std::string& text :
       {counting("0", 1, "lt.s32 9"), counting("0", 8, "ne.s32 32"), counting("20", -5, "gt.s32 -7"),
        counting("3", 4, "le.u32 31"), counting("12", -3, "ne.s32 0"), counting("7", 1, "lt.s32 2"),
        counting("-4", 2, "ge.s32 100"), counting("5", 1, "eq.s32 6")}) {
    const std::string code = shaped(text);
    CHECK(count(code, "setp") == 0);
    CHECK(count(code, "bra") == 0);
    CHECK(count(code, "mad.lo.u32") >= 1);
  }
}

TEST_CASE("a loop stays where its turns are too many or the text forbids copies") {
  CHECK(count(shaped(counting("0", 1, "lt.s32 300")), "bra") > 0);
  const std::string code = shaped(counting("0", 1, "lt.s32 9", ".pragma \"nounroll\";"));
  CHECK(count(code, "mad.lo.u32 %r") == 1);
  CHECK(count(code, "bra") == 1);
}

TEST_CASE("a loop in a loop is unrolled only if its counter starts anew each time") {
  const auto nested = [](const std::string& outside, const std::string& inside) {
    return "mov.u32 %r5,0;mov.u32 %r2,%lane;" + outside + "\nOUTER: " + inside +
           "\nINNER: mad.lo.u32 %r2,%r2,3,%r1;add.s32 %r1,%r1,1;setp.lt.s32 %p1,%r1,4;@%p1 bra INNER;\n"
           "add.s32 %r5,%r5,1;setp.lt.s32 %p2,%r5,%lane;@%p2 bra OUTER;\nmov.u32 %out,%r2;\n";
  };
  shaped(nested("mov.u32 %r1,0;", ""));
  shaped(nested("", "mov.u32 %r1,0;"));
}

TEST_CASE("an instruction that only a selection reads writes the selection's result under a guard") {
  const std::string choose = "setp.lt.u32 %p1,%lane,11;mul.lo.u32 %r1,%lane,77;mul.lo.u32 %r2,%lane,31;";
  const std::string one = shaped(choose + "popc.b32 %r3,%r1;selp.b32 %out,%r3,%r2,%p1;\n");
  CHECK(count(one, "selp") == 0);
  CHECK(count(one, "@%p0 popc.b32") == 1);
  const std::string other = shaped(choose + "popc.b32 %r3,%r1;selp.b32 %out,%r2,%r3,%p1;\n");
  CHECK(count(other, "selp") == 0);
  // A value that is read later, and one that another instruction reads too, stay.
  CHECK(count(shaped(choose + "popc.b32 %r3,%r1;selp.b32 %r4,%r3,%r2,%p1;xor.b32 %out,%r4,%r2;\n"), "selp") ==
        1);
  CHECK(count(shaped(choose + "popc.b32 %r3,%r1;selp.b32 %r4,%r3,%r2,%p1;xor.b32 %out,%r4,%r3;\n"), "selp") ==
        1);
  // Both sides read what the selection writes.
  shaped(choose +
         "LOOP: and.b32 %r5,%r1,1;setp.eq.u32 %p2,%r5,1;mad.lo.u32 %r3,%r1,3,1;shr.u32 %r4,%r1,1;selp.b32 "
         "%r1,%r3,%r4,%p2;add.u32 %r2,%r2,1;setp.lt.u32 %p3,%r2,900;@%p3 bra LOOP;mov.u32 %out,%r1;\n");
  // The source changes between the instruction and the selection.
  shaped(choose +
         "mov.u32 %r5,%r1;popc.b32 %r3,%r5;add.u32 %r5,%r5,9;selp.b32 %out,%r3,%r2,%p1;add.u32 "
         "%out,%out,%r5;\n");
}

TEST_CASE("a selection at the head of a loop is guarded, so that the loop has one branch") {
  const std::string code = shaped(
      "mov.u32 %r1,%lane;mov.u32 %r2,0;\nHEAD: add.u32 %r2,%r2,%r1;and.b32 %r3,%r1,4;setp.eq.u32 "
      "%p1,%r3,0;@%p1 bra "
      "JOIN;\nmul.lo.u32 %r2,%r2,7;xor.b32 %r2,%r2,%lane;shl.b32 %r4,%r2,3;sub.u32 %r2,%r4,%r2;add.u32 "
      "%r2,%r2,5;\n"
      "JOIN: add.u32 %r1,%r1,5;setp.lt.u32 %p2,%r1,%r2;setp.lt.and.u32 %p3,%r1,60,%p2;@%p3 bra "
      "HEAD;\nmov.u32 "
      "%out,%r2;\n");
  CHECK(count(code, "bra") == 1);
  CHECK(count(code, "ssy") == 1);
}

TEST_CASE(
    "products and shifts of 64 bits are added to in one instruction, and masked parts converted in one") {
  const std::string wide = "cvt.u64.u32 %rd1,%lane;add.u64 %rd2,%rd1,4294967290;";
  const std::string low = "shr.u64 %rd5,%rd4,7;cvt.u32.u64 %out,%rd5;\n";
  CHECK(count(shaped(wide + "mul.lo.s64 %rd3,%rd2,%rd1;add.s64 %rd4,%rd3,%rd2;" + low), "mad.lo.u64") == 1);
  CHECK(count(shaped(wide + "shl.b64 %rd3,%rd2,5;add.s64 %rd4,%rd1,%rd3;" + low), "shladd.u64") == 1);
  CHECK(count(shaped(wide + "shl.b64 %rd3,%rd2,5;add.s64 %rd4,%rd3,%rd3;" + low), "shladd.u64") == 0);
  const std::string hashed = "mul.lo.u32 %r1,%lane,-1640531527;";
  for (const auto& [mask, op] : {std::pair{255, "cvt.rn.f32.u8"}, std::pair{65535, "cvt.rn.f32.u16"}})
    CHECK(count(shaped(hashed +
                       fmt::format("and.b32 %r2,%r1,{};cvt.rn.f32.u32 %f1,%r2;mov.b32 %out,%f1;\n", mask)),
                op) == 1);
}

TEST_CASE("a product that several sums read is fused into each of them") {
  const std::string text =
      "cvt.rn.f32.u32 %f1,%lane;mul.f32 %f2,%f1,0f3DCCCCCD;add.f32 %f3,%f2,0f40000000;sub.f32 "
      "%f4,%f1,%f2;mul.f32 "
      "%f5,%f3,%f4;mov.b32 %out,%f5;\n";
  const std::string code = shaped(text);
  CHECK(count(code, "mul.rn.f32") == 1);
  CHECK(count(code, "fma.rn.f32") + count(code, "nfma.rn.f32") >= 2);
}

TEST_CASE("words at constant places of shared memory are loaded together") {
  const std::string code = shaped(
      "setp.ne.u32 %p1,%lane,0;@!%p1 st.shared.v4.u32 [room],{1,2,3,4};\nbar.sync 0;\nld.shared.u32 "
      "%r1,[room];ld.shared.u32 %r2,[room+4];ld.shared.u32 %r3,[room+8];ld.shared.u32 %r4,[room+12];\n"
      "mad.lo.u32 %out,%r1,3,%r2;mad.lo.u32 %out,%r3,5,%out;mad.lo.u32 %out,%r4,7,%out;\n",
      ".shared .align 16 .b8 room[64];\n");
  CHECK(count(code, "ld.shared.v4") == 1);
}

TEST_CASE("loops that count in 64 bits become copies, too") {
  const auto down = [](const std::string& start) {
    return "cvt.u64.u32 %rd1,%lane;" + start +
           "mov.u32 %r2,1;\nLOOP: mad.lo.u32 %r2,%r2,5,%lane;add.s64 %rd2,%rd2,-1;setp.ne.s64 "
           "%p1,%rd2,0;@%p1 bra "
           "LOOP;\nmov.u32 %out,%r2;\n";
  };
  CHECK(count(shaped(down("mov.u64 %rd2,9;")), "setp") == 0);
  CHECK(count(shaped(down("add.s64 %rd2,%rd1,1;")), "setp.gt.s64") == 4);
  const auto up = [](const std::string& end) {
    return "cvt.u64.u32 %rd1,%lane;" + end +
           "mov.u32 %r2,1;mov.u64 %rd2,-3;\nLOOP: mad.lo.u32 %r2,%r2,5,%lane;add.s64 %rd2,%rd2,2;setp.lt.s64 "
           "%p1,%rd2,%rd3;@%p1 bra LOOP;\nmov.u32 %out,%r2;\n";
  };
  for (const std::string end :
       {"add.s64 %rd3,%rd1,20;", "mov.u64 %rd4,-9223372036854775808;add.s64 %rd3,%rd4,%rd1;"})
    CHECK(count(shaped(up(end)), "setp.lt.s64") > 1);
}

TEST_CASE("a loop with a known number of turns that data may end is one run of turns with branches out") {
  const auto looking = [](int turns) {
    return fmt::format(
        "mov.u32 %r1,0;mul.lo.u32 %r2,%lane,40503;mov.u32 %r4,3;\nLOOP: mad.lo.u32 "
        "%r2,%r2,25173,13849;and.b32 "
        "%r3,%r2,248;setp.ne.s32 %p1,%r3,0;add.s32 %r4,%r4,7;add.s32 %r1,%r1,1;setp.lt.u32 "
        "%p2,%r1,{};and.pred "
        "%p3,%p1,%p2;@%p3 bra LOOP;\nmad.lo.u32 %out,%r2,31,%r1;add.u32 %out,%out,%r4;\n",
        turns);
  };
  const std::string code = shaped(looking(20));
  CHECK(count(code, "setp.lt.u32") == 0);
  CHECK(count(code, "bra") == 19);
  CHECK(count(shaped(looking(900)), "setp.lt") == 1);
}

TEST_CASE("a selection that meets where another one does gets guards") {
  const std::string code = shaped(
      "and.b32 %r1,%lane,3;mov.u32 %r2,7;setp.eq.s32 %p1,%r1,0;@%p1 bra ZERO;\nsetp.eq.s32 %p2,%r1,1;@%p2 "
      "bra "
      "ONE;\nsetp.ne.s32 %p3,%r1,2;@%p3 bra MORE;\nadd.s32 %r2,%r2,1;bra.uni END;\nONE: add.s32 "
      "%r2,%r2,-4;bra.uni "
      "END;\nZERO: mul.lo.s32 %r2,%r2,3;bra.uni END;\nMORE: xor.b32 %r2,%r2,60;\nEND: add.u32 "
      "%out,%r2,%lane;\n");
  CHECK(count(code, "@%p0 xor.b32") + count(code, "@!%p0 xor.b32") == 1);
}
