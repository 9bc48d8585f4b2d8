// Tests what the PTX front end fuses as the hardware's assembler does: each kernel has the results of the
// same text without fusion.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "tests/ptx/one_warp.h"

using namespace glint;

namespace {

// Returns a kernel's text with a hash of the lane in %r1, %r2 and %r3.
std::string hashed(const std::string& body) {
  return "mul.lo.u32 %r1,%lane,-1640531527;xor.b32 %r2,%r1,29;mul.lo.u32 %r2,%r2,-2048144777;shr.u32 "
         "%r3,%r2,7;sub.u32 %r3,%r3,%r1;\n" +
         body;
}
std::string fused(const std::string& body) {
  return shaped(hashed(body));
}

}  // namespace

TEST_CASE("two sums of which one only feeds the other are one instruction, whatever their signs") {
  for (const auto& [body, name] : std::vector<std::pair<std::string, std::string>>{
           {"add.u32 %r4,%r1,%r2;add.u32 %out,%r4,%r3;", "add3.u32"},
           {"add.s32 %r4,%r1,%r2;add.s32 %out,%r3,%r4;", "add3.u32"},
           {"sub.u32 %r4,%r1,%r2;add.u32 %out,%r4,%r3;", "addsub.u32"},
           {"add.u32 %r4,%r1,%r2;sub.u32 %out,%r4,%r3;", "addsub.u32"},
           {"sub.u32 %r4,%r1,%r2;sub.u32 %out,%r3,%r4;", "addsub.u32"},
           {"add.u32 %r4,%r1,%r2;sub.u32 %out,%r3,%r4;", "subsub.u32"},
           {"sub.u32 %r4,%r1,%r2;sub.u32 %out,%r4,%r3;", "subsub.u32"},
       })
    CHECK(count(fused(body), name) == 1);
  // Another instruction reads the first sum, or its source has changed since.
  CHECK(count(fused("add.u32 %r4,%r1,%r2;add.u32 %r5,%r4,%r3;xor.b32 %out,%r4,%r5;"), "add3") == 0);
  CHECK(count(fused("mov.u32 %r6,%r3;add.u32 %r4,%r1,%r6;add.u32 %r6,%r6,%lane;add.u32 %out,%r4,%r6;"),
              "add3") == 0);
}

TEST_CASE("shifts, bounds and products take in a sum") {
  CHECK(count(fused("shr.u32 %r4,%r1,5;add.u32 %out,%r4,%r2;"), "shradd.u32") == 1);
  CHECK(count(fused("shr.s32 %r4,%r1,30;add.s32 %out,%r2,%r4;"), "shradd.s32") == 1);
  CHECK(count(fused("shr.s32 %r4,%r1,%lane;add.s32 %out,%r2,%r4;"), "shradd") == 0);
  CHECK(count(fused("add.s32 %r4,%r1,-9;min.s32 %out,%r4,%r2;"), "addmin.s32") == 1);
  CHECK(count(fused("add.u32 %r4,%r1,%r3;max.u32 %out,%r2,%r4;"), "addmax.u32") == 1);
  CHECK(count(fused("mul.lo.s32 %r4,%r1,1000;sub.s32 %out,%r2,%r4;"), "mad.lo") == 1);
  CHECK(count(fused("mul.lo.s32 %r4,%r1,%r3;sub.s32 %out,%r2,%r4;"), "mad.lo") == 0);
}

TEST_CASE("logic of up to three words is one instruction") {
  for (const std::string body : {
           "and.b32 %r4,%r1,%r2;xor.b32 %out,%r4,%r3;",
           "not.b32 %r4,%r1;and.b32 %out,%r4,%r2;",
           "and.b32 %r4,%r1,%r2;not.b32 %r5,%r1;and.b32 %r6,%r5,%r3;xor.b32 %out,%r4,%r6;",
           "and.b32 %r4,%r1,%r2;and.b32 %r5,%r1,%r3;and.b32 %r6,%r2,%r3;xor.b32 %r7,%r4,%r5;xor.b32 "
           "%out,%r7,%r6;",
           "xor.b32 %r4,%r1,%r2;and.b32 %out,%r4,255;",
           "or.b32 %r4,%r1,%r1;xor.b32 %out,%r4,%r2;",
       }) {
    const std::string text = fused(body);
    CHECK(count(text, "lop3.b32") == 1);
    CHECK(count(text, "not.b32") + count(text, "and.b32") + count(text, "or.b32 ") == 1);  // of the hash
  }
  // There are four words here, and here two constants.
  CHECK(count(fused("and.b32 %r4,%r1,%r2;xor.b32 %r5,%r3,%lane;or.b32 %out,%r4,%r5;"), "lop3.b32") == 1);
  CHECK(count(fused("and.b32 %r4,%r1,255;xor.b32 %out,%r4,3;"), "lop3.b32") == 0);
}

TEST_CASE("high words, masks and strides need no operations of 64 bits") {
  CHECK(count(fused("mul.wide.u32 %rd1,%r1,-858993459;shr.u64 %rd2,%rd1,35;cvt.u32.u64 %out,%rd2;"),
              "mul.hi.u32") == 1);
  const std::string whole =
      fused("mul.wide.u32 %rd1,%r1,-858993459;shr.u64 %rd2,%rd1,32;cvt.u32.u64 %out,%rd2;");
  CHECK(count(whole, "mul.hi.u32") == 1);
  CHECK(count(whole, "shr.u64") == 0);
  CHECK(count(fused("cvt.u64.u32 %rd1,%r1;and.b64 %rd2,%rd1,1020;add.s64 %rd3,%rd2,5;cvt.u32.u64 %out,%rd3;"),
              "and.b64") == 0);
  CHECK(
      count(
          fused("mul.wide.u32 %rd1,%r1,16;shl.b64 %rd2,%rd1,2;xor.b64 %rd3,%rd2,%rd1;cvt.u32.u64 %out,%rd3;"),
          "shl.b64") == 1);
  CHECK(
      count(fused("mul.wide.s32 %rd1,%r1,16;shl.b64 %rd2,%rd1,2;shr.u64 %rd3,%rd2,20;cvt.u32.u64 %out,%rd3;"),
            "shl.b64") == 0);
}

TEST_CASE("products are fused into sums whose registers a loop writes, to the bit of fma") {
  // 1 + 2^-12 squared has a bit that the product alone loses.
  const std::string text =
      "cvt.rn.f32.u32 %f1,%lane;mov.f32 %f2,0f3F800800;mov.f32 %f3,0f3F800800;mov.u32 %r1,0;\n"
      "LOOP: mul.f32 %f4,%f2,%f3;sub.f32 %f5,%f4,%f2;mul.f32 %f6,%f5,%f1;sub.f32 %f3,%f3,%f6;mul.f32 "
      "%f7,%f1,0f3F000001;add.f32 %f2,%f7,%f3;\n"
      "add.u32 %r1,%r1,1;setp.lt.u32 %p1,%r1,3;@%p1 bra LOOP;\nmov.b32 %out,%f2;\n";
  const std::string code = shaped(text);
  CHECK(count(code, "mul.rn.f32") == 0);
  CHECK(count(code, "fms.rn.f32") == count(code, "nfma.rn.f32"));
  CHECK(count(code, "fms.rn.f32") >= 1);
  frontend::PtxOptions apart;
  apart.contract = false;
  CHECK(outputs(storing(text)) != outputs(storing(text), kWarp, apart));
  // A factor changes before the sum; a sum with a rounding modifier stays alone.
  CHECK(
      count(shaped("cvt.rn.f32.u32 %f1,%lane;mov.f32 %f2,%f1;mul.f32 %f3,%f1,%f2;add.f32 %f2,%f2,%f1;add.f32 "
                   "%f4,%f3,%f2;mov.b32 %out,%f4;\n"),
            "fma.rn") == 0);
  CHECK(
      count(shaped("cvt.rn.f32.u32 %f1,%lane;mul.f32 %f3,%f1,%f1;add.rn.f32 %f4,%f3,%f1;mov.b32 %out,%f4;\n"),
            "fma.rn") == 0);
}

TEST_CASE("one lane does the atomics of a warp at an address that all lanes share") {
  const std::string room = ".global .align 4 .u32 room[4];\n";
  const std::string some = "mov.u64 %rd1,room;setp.gt.u32 %p1,%lane,4;\n@!%p1 bra DONE;\n";
  const std::string read = "DONE: bar.sync 0;mov.u64 %rd2,room;ld.global.u32 %out,[%rd2];\n";
  const auto of = [&](const std::string& body) { return shaped(hashed(some + body + read), room); };
  const std::string sum = of("atom.global.add.u32 %r4,[%rd1],%r1;\n");
  CHECK(count(sum, "redux.sync.add.u32") == 1);
  CHECK(count(sum, "red.global.add.u32") == 1);
  CHECK(count(sum, "atom.") == 0);
  const std::string number = of("red.global.add.u32 [%rd1],3;\n");
  CHECK(count(number, "redux") == 0);
  CHECK(count(number, "popc.b32") == 1);
  CHECK(count(of("red.global.max.s32 [%rd1],%r2;\n"), "redux.sync.max.s32") == 1);
  // The old values are those of lanes that take turns.
  const std::string places = shaped(
      hashed(some + "atom.global.add.u32 %r4,[%rd1],2;mad.lo.u32 %out,%lane,64,%r4;\nDONE: bar.sync 0;\n"),
      room);
  CHECK(count(places, "shfl.sync.idx.b32") == 1);
  // Lanes have addresses of their own; floats are not added in another order.
  CHECK(count(of("mad.wide.u32 %rd3,%lane,0,%rd1;red.global.add.u32 [%rd3],%r1;\n"), "redux") == 0);
  CHECK(count(of("cvt.rn.f32.u32 %f1,%lane;red.global.add.f32 [%rd1],%f1;\n"), "activemask") == 0);
}

TEST_CASE("nothing moves across a division that rounds correctly, and a loop with one is not unrolled") {
  const std::string room = ".global .align 4 .f32 room[64];\n";
  const std::string body =
      "mov.u64 %rd1,room;mad.wide.u32 %rd2,%lane,4,%rd1;ld.global.f32 %f1,[%rd2];div.rn.f32 "
      "%f2,%f1,0f40400000;ld.global.f32 %f3,[%rd2+4];add.f32 %f4,%f2,%f3;mov.b32 %out,%f4;\n";
  const std::string text = shaped(body, room);
  CHECK(text.find("div.rn.f32") < text.rfind("ld.global"));
  const std::string quick = shaped(std::string(body).replace(body.find("div.rn"), 6, "mul.rn"), room);
  CHECK(quick.find("mul.rn.f32") > quick.rfind("ld.global"));
}

TEST_CASE("loads are issued together, in their order, as far as an assembler's few registers allow") {
  std::string loads, sums;
  for (int i = 0; i < 60; ++i) {
    const std::string f = "%x" + std::to_string(i);
    loads += "ld.global.f32 " + f + ",[%rd2+" + std::to_string(4 * i) + "];\n";
    sums += "fma.rn.f32 %f0,%f0,%f0," + f + ";\n";
  }
  const std::string text =
      shaped(".reg .f32 %x<64>;mov.u64 %rd1,room;mad.wide.u32 %rd2,%lane,4,%rd1;mov.f32 %f0,0f00000000;\n" +
                 loads + sums + "mov.b32 %out,%f0;\n",
             ".global .align 4 .f32 room[128];\n");
  const std::string first = text.substr(0, text.find("fma.rn.f32"));
  CHECK(count(first, "ld.global") >= 16);
  CHECK(count(first, "ld.global") <= 29);
  CHECK(count(text, "ld.global") == 60);
  CHECK(count(text, "ld.local") == 0);
  for (int i = 1; i < 60; ++i) {
    const auto at = [&](int k) { return text.find(" + " + std::to_string(4 * k) + "]"); };
    REQUIRE(at(i) != std::string::npos);
    if (i > 1) CHECK(at(i - 1) < at(i));
  }
}
