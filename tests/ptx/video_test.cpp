// Tests video instructions on one number by what they compute.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

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
