// Tests which types of registers and numbers PTX instructions take.
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

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
