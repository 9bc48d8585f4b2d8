// Tests the verifier's walk over paths: regions, traces, registers written on each path, frames, stages, and
// programs that it must accept.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "isa/descriptors.h"
#include "isa/op_row.h"
#include "isa/text.h"
#include "isa/verify.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;
using Catch::Contains;

namespace {

// Returns all messages about a program with this header and code, one per line, or "" for a sound program.
std::string verdict(const std::string& code, const std::string& header = "") {
  const Program p = parse(".registers 32\n" + header + "\n" + code, "paths");
  Diagnostics d;
  verify(p, d);
  std::string out;
  for (const std::string& message : d.messages()) out += (out.empty() ? "" : "\n") + message;
  return out;
}

constexpr const char* kRaygen = ".stage ray_generation\n.local_bytes 48";
constexpr const char* kMiss = ".stage miss\n.local_bytes 16";
constexpr const char* kTrace =
    "rt.trace %p0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0f3F800000, 0f7F800000, %r0, 16;\n";

}  // namespace

TEST_CASE("lanes meet only inside a region that is open, and regions nest on every path") {
  CHECK(verdict("setp.eq.u32 %p0, %laneid, 1; ssy A; ssy B; @%p0 bra A; B: join; A: join; exit;") == "");
  CHECK_THAT(verdict("A: join; exit;"), Contains("comes to the join at 0 outside its region: nothing open"));
  CHECK_THAT(verdict("setp.eq.u32 %p0, %laneid, 1; @%p0 bra A; A: join; exit;"),
             Contains("instruction 1 (bra): comes to the join at 2 outside its region"));
  CHECK_THAT(verdict("setp.eq.u32 %p0, %laneid, 1; @%p0 bra N; ssy A; N: mov.b32 %r1, 1; A: join; exit;"),
             Contains("comes to instruction 3 with") && Contains("inside the region of join 4") &&
                 Contains("nothing open"));
  CHECK_THAT(verdict("LOOP: ssy A; bra LOOP; A: join; exit;"),
             Contains("instruction 1 (bra): comes to instruction 0 with inside the region of join 2"));
  CHECK_THAT(verdict("ssy A; ssy B; A: join; B: join; exit;"),
             Contains("comes to the join at 3 outside its region"));
  CHECK_THAT(verdict("ssy A; exit; A: join; exit;"), Contains("no path leads to the join at 2"));
  CHECK_THAT(verdict("setp.eq.u32 %p0, %laneid, 1; @%p0 ssy A; A: join; exit;"),
             Contains("there is a guard, but the op moves all lanes of the warp"));
}

TEST_CASE("code that no lane reaches and code that runs off its end are refused") {
  CHECK_THAT(verdict("bra END; mov.b32 %r1, 1; mov.b32 %r2, 1; END: exit;"),
             Contains("instruction 1 (mov.b32): no path leads here, nor to the next instructions up to 2"));
  CHECK(verdict("setp.eq.u32 %p0, %laneid, 1; @%p0 bra END; mov.b32 %r1, 1; END: exit;") == "");
  CHECK_THAT(verdict("exit; exit;"), Contains("instruction 1 (exit): no path leads here"));
  CHECK_THAT(verdict("mov.b32 %r1, 1;"), Contains("the code can run off its end here"));
  CHECK_THAT(verdict("setp.eq.u32 %p0, %laneid, 1; @%p0 exit;"),
             Contains("the code can run off its end here"));
}

TEST_CASE("a register or predicate that nothing has written on a path is not read") {
  CHECK_THAT(verdict("add.u32 %r1, %r2, 1; exit;"),
             Contains("instruction 0 (add.u32): %r2 is read, but nothing has written it on a path to here"));
  CHECK(verdict("add.u32 %r1, %r0, 1; exit;") == "");  // the stack pointer
  CHECK_THAT(verdict("@%p3 exit; exit;"), Contains("%p3 is read"));
  CHECK_THAT(verdict("mov.b32 %r2, 1; add.u64 %rd4, %rd2, 1; exit;"), Contains("%r3 is read"));
  CHECK_THAT(verdict("setp.eq.u32 %p0, %laneid, 1; @%p0 bra N; mov.b32 %r1, 1; N: mov.b32 %r2, %r1; exit;"),
             Contains("instruction 3 (mov.b32): %r1 is read, but nothing has written it on a path"));
  // In a loop, a register that is written later counts as not written before.
  CHECK_THAT(verdict("L: add.u32 %r1, %r2, 1; mov.b32 %r2, 1; setp.eq.u32 %p0, %r1, 9; @%p0 bra L; exit;"),
             Contains("instruction 0 (add.u32): %r2 is read"));
}

TEST_CASE("a guarded write serves the lanes of its guard") {
  const std::string p = "setp.eq.u32 %p0, %laneid, 1; setp.eq.u32 %p1, %laneid, 2; ";
  CHECK(verdict(p + "@%p0 mov.b32 %r1, 1; @!%p0 mov.b32 %r1, 2; mov.b32 %r2, %r1; exit;") == "");
  CHECK(verdict(p + "@%p0 mov.b32 %r1, 1; @%p0 mov.b32 %r2, %r1; exit;") == "");
  CHECK(verdict(p + "@%p0 mov.b32 %r1, 1; @!%p0 exit; mov.b32 %r2, %r1; exit;").find("%r1") !=
        std::string::npos);
  CHECK(verdict(p + "@%p0 mov.b32 %r1, 1; @!%p0 bra N; mov.b32 %r2, %r1; N: exit;") == "");
  CHECK_THAT(
      verdict(p + "@%p0 mov.b32 %r1, 1; @%p0 bra N; mov.b32 %r2, %r1; N: exit;"),
      Contains(
          "instruction 4 (mov.b32): %r1 is read by all lanes, but only lanes under a guard have written it"));
}

TEST_CASE("shaders that are called use every register and predicate but the stack pointer") {
  const std::string call =
      std::string(kTrace) +
      "mov.b32 %r1, 7; add.u32 %r0, %r0, 48; call.sbt.hit; rt.end; sub.u32 %r0, %r0, 48; ";
  CHECK(verdict(call + "exit;", kRaygen) == "");
  CHECK_THAT(verdict(call + "mov.b32 %r2, %r1; exit;", kRaygen), Contains("%r1 is read"));
  CHECK_THAT(verdict(call + "@%p0 exit; exit;", kRaygen), Contains("%p0 is read"));
  CHECK_THAT(verdict(std::string(kTrace) + "add.u32 %r0, %r0, 32; call.sbt.hit; rt.end; exit;", kRaygen),
             Contains("call.sbt.hit") && Contains("%r0 is 32 bytes above") && Contains("has 48"));
}

TEST_CASE("functions are called, not fallen into, and may have written what they write") {
  if (find_op("call") < 0) return;
  CHECK(verdict("call F; mov.b32 %r2, %r1; exit; F: mov.b32 %r1, 1; ret;") == "");
  CHECK_THAT(verdict("call F; mov.b32 %r2, %r3; exit; F: mov.b32 %r1, 1; ret;"), Contains("%r3 is read"));
  CHECK_THAT(verdict("call F; F: mov.b32 %r1, 1; ret;"),
             Contains("comes to instruction 1 with nothing open"));
}

TEST_CASE("ops of a trace stand inside it") {
  CHECK_THAT(verdict("rt.resume %p0; exit;", kRaygen), Contains("no rt.trace is open on a path to here"));
  CHECK_THAT(verdict("rt.end; exit;", kRaygen), Contains("no trace is innermost here: nothing open"));
  CHECK_THAT(verdict(std::string(kTrace) + "ssy A; rt.end; A: join; exit;", kRaygen),
             Contains("no trace is innermost here: inside a trace, the region of join"));
  CHECK_THAT(verdict("ssy A; " + std::string(kTrace) + "@%p0 bra A; rt.end; A: join; exit;", kRaygen),
             Contains("comes to the join at 4 outside its region"));
}

TEST_CASE("lanes that part inside a trace meet before its end") {
  const std::string part = "@%p0 bra A; rt.end; exit; A: rt.end; exit;";
  CHECK_THAT(verdict(kTrace + part, kRaygen),
             Contains("instruction 1 (bra): lanes may diverge inside a trace"));
  CHECK(verdict(std::string(kTrace) + "ssy A; @%p0 bra A; mov.b32 %r1, 1; A: join; rt.end; exit;", kRaygen) ==
        "");
}

TEST_CASE("ops and specials stand in shaders of their stages") {
  CHECK_THAT(verdict("rt.ignore;", ".stage closest_hit"),
             Contains("stage closest_hit, but belongs in any_hit"));
  CHECK_THAT(verdict("rt.report %p0, 0f3F800000, 1; exit;", kRaygen), Contains("belongs in intersection"));
  CHECK_THAT(verdict(kTrace + std::string("rt.end; exit;")),
             Contains("belongs in ray_generation, closest_hit, miss"));
  CHECK_THAT(verdict("exit;", kMiss), Contains("belongs in ray_generation, compute"));
  CHECK_THAT(verdict("ret;"), Contains("a return outside a function"));
  CHECK(verdict("ret;", kMiss) == "");
  CHECK_THAT(verdict("mov.b32 %r1, %payload; exit;"), Contains("belongs in any_hit, closest_hit, miss"));
  CHECK_THAT(verdict("mov.b32 %r1, %hit.u; ret;", kMiss),
             Contains("belongs in intersection, any_hit, closest_hit"));
  CHECK(verdict("mov.b32 %r1, %hit.t; ret;", kMiss) == "");
  CHECK_THAT(verdict("mov.b32 %r1, %tid.x; ret;", kMiss), Contains("belongs in compute"));
}

TEST_CASE("frames, shared memory and the constant bank are not left by a known displacement") {
  CHECK(verdict("st.local.b32 [%r0 + 12], 1; ret;", kMiss) == "");
  CHECK_THAT(verdict("st.local.b32 [%r0 + 16], 1; ret;", kMiss),
             Contains("touches bytes 16 to 19 of the frame, which has 16"));
  CHECK_THAT(verdict("st.local.v2.b32 [%r0 + 12], {1, 2}; ret;", kMiss), Contains("touches bytes 12 to 19"));
  CHECK_THAT(verdict("st.local.b32 [%r0 - 4], 1; ret;", kMiss), Contains("touches bytes -4 to -1"));
  CHECK(verdict("add.u32 %r0, %r0, 16; st.local.b32 [%r0 - 4], 1; sub.u32 %r0, %r0, 16; ret;", kMiss) == "");
  CHECK_THAT(verdict("add.u32 %r0, %r0, 16; ret;", kMiss),
             Contains("%r0 is 16 bytes from its value at entry"));
  CHECK(verdict(fmt::format("ld.const.b32 %r1, [{}]; exit;", kLargestBankBytes - 4)) == "");
  CHECK_THAT(verdict(fmt::format("ld.const.b32 %r1, [{}]; exit;", kLargestBankBytes)),
             Contains(fmt::format("but there are {}", kLargestBankBytes)));
  CHECK_THAT(verdict("ld.local.b32 %r1, [0]; exit;"), Contains("touches bytes 0 to 3, but there are 0"));
  if (find_op("ld.shared.b32") < 0) return;
  CHECK(verdict("ld.shared.b32 %r1, [60]; exit;", ".shared_bytes 64") == "");
  CHECK_THAT(verdict("ld.shared.b32 %r1, [64]; exit;", ".shared_bytes 64"),
             Contains("touches bytes 64 to 67"));
  CHECK_THAT(verdict("ld.shared.b32 %r1, [0]; ret;", ".stage miss\n.shared_bytes 64"),
             Contains("belongs in compute"));
}

TEST_CASE("no instruction writes a register twice") {
  CHECK_THAT(verdict("ld.const.v2.b32 {%r1, %r1}, [0]; exit;"), Contains("%r1 is written twice"));
  CHECK(verdict("ld.const.v2.b32 {%r2, %r1}, [0]; exit;") == "");
}

TEST_CASE("a program twice as long takes about twice the time") {
  const auto seconds = [](int blocks) {
    std::string code = "setp.eq.u32 %p0, %laneid, 1;\nmov.b32 %r1, 1;\n";
    for (int i = 0; i < blocks; ++i)
      code += fmt::format(
          "L{0}: ssy J{0};\n@%p0 bra J{0};\nadd.u32 %r1, %r1, %r1;\nJ{0}: join;\n@%p0 bra L{0};\n", i);
    const Program p = parse(".registers 32\n" + code + "exit;\n", "long");
    double best = 1e9;
    for (int run = 0; run < 3; ++run) {
      const auto start = std::chrono::steady_clock::now();
      Diagnostics d;
      verify(p, d);
      CHECK(d.messages().empty());
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
  };
  CHECK(seconds(16000) < 16 * seconds(4000) + 0.01);  // quadratic time would be 16 times, linear time 4 times
}
