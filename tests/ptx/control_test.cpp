// Tests branches, loops and calls of PTX kernels: what each lane computes, and where lanes meet again.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "isa/text.h"
#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

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
