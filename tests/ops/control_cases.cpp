// Lists programs for the control ops. The expected words are plain C++ for one thread, and masks of lanes.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/control_cases.h"

#include <utility>

namespace glint::test {
namespace {

// Returns the lanes of the thread's warp for which the condition on the thread's number holds.
template <class Condition>
uint32_t lanes(uint32_t thread, Condition condition) {
  uint32_t out = 0;
  for (uint32_t lane = 0; lane < 32; ++lane) out |= uint32_t(condition(thread / 32 * 32 + lane)) << lane;
  return out;
}

// A loop of another length in each lane, with a branch in it.
constexpr const char* kLoop = R"(
    rem.u32 %r5, %r4, 7;
    mov.b32 %r20, 1;
    mov.b32 %r21, 0;
    mov.b32 %r6, 0;
    ssy DONE;
LOOP:
    setp.ge.u32 %p1, %r6, %r5;
    @%p1 bra DONE;
    and.b32 %r7, %r6, 1;
    setp.ne.u32 %p2, %r7, 0;
    ssy NEXT;
    @!%p2 bra EVEN;
    mul.lo.u32 %r20, %r20, 3;
    bra NEXT;
EVEN:
    add.u32 %r20, %r20, %r4;
NEXT:
    join;
    add.u32 %r6, %r6, 1;
    activemask.b32 %r21;
    bra LOOP;
DONE:
    join;
)";
ControlWords loop(uint32_t thread) {
  uint32_t value = 1;
  for (uint32_t i = 0; i < thread % 7; ++i) value = i % 2 ? value * 3 : value + thread;
  // In the last turn of a lane, the lanes run that have at least as many turns.
  const uint32_t last = lanes(thread, [&](uint32_t other) { return other % 7 >= thread % 7; });
  return {value, thread % 7 ? last : 0};
}

// Two nested regions. The masks inside of them and behind them show who has met.
constexpr const char* kRegions = R"(
    and.b32 %r5, %r4, 3;
    setp.lt.u32 %p1, %r5, 3;
    setp.eq.u32 %p2, %r5, 1;
    mov.b32 %r20, 0;
    ssy OUTER;
    @!%p1 bra OUTER;
    ssy INNER;
    @%p2 bra INNER;
    activemask.b32 %r20;
INNER:
    join;
    activemask.b32 %r6;
    add.u32 %r20, %r20, %r6;
OUTER:
    join;
    activemask.b32 %r21;
)";
ControlWords regions(uint32_t thread) {
  const uint32_t inner = lanes(thread, [](uint32_t t) { return t % 4 == 0 || t % 4 == 2; }),
                 outer = lanes(thread, [](uint32_t t) { return t % 4 < 3; });
  return {(thread % 4 < 3 ? outer : 0) + (thread % 4 == 0 || thread % 4 == 2 ? inner : 0), 0xffff'ffff};
}

constexpr const char* kTable = R"(
    mul.lo.u32 %r5, %r4, 5;
    and.b32 %r5, %r5, 3;
    setp.ne.u32 %p1, %r4, 9;
    mov.b32 %r20, 77;
    mov.b32 %r21, 0;
    ssy MEET;
    @%p1 brx.idx %r5, TABLE;
    bra MEET;
TABLE:
    bra ZERO;
    bra ONE;
    bra TWO;
    bra ONE;
ZERO:
    mov.b32 %r20, 100;
    bra SEE;
ONE:
    mov.b32 %r20, 200;
    bra SEE;
TWO:
    mov.b32 %r20, 300;
SEE:
    activemask.b32 %r21;
    bra MEET;
MEET:
    join;
    activemask.b32 %r6;
    add.u32 %r20, %r20, %r6;
)";
ControlWords table(uint32_t thread) {
  const uint32_t index = thread * 5 % 4;
  if (thread == 9) return {77 - 1u, 0};
  // Lanes that chose one entry go together, although two entries lead to one place.
  return {(index == 0   ? 100u
           : index == 2 ? 300u
                        : 200u) -
              1,
          lanes(thread, [&](uint32_t t) { return t != 9 && t * 5 % 4 == index; })};
}

// A function that some lanes call twice, and which calls another. Guards let lanes return early.
constexpr const char* kCall = R"(
    mov.b32 %r20, %r4;
    setp.lt.u32 %p1, %r4, 20;
    @%p1 call OUTER_FUNCTION;
    call INNER_FUNCTION;
    activemask.b32 %r21;
)";
constexpr const char* kFunctions = R"(
OUTER_FUNCTION:
    add.u32 %r20, %r20, 1000;
    setp.lt.u32 %p2, %r4, 5;
    @%p2 ret;
    call INNER_FUNCTION;
    add.u32 %r20, %r20, 1;
    ret;
INNER_FUNCTION:
    and.b32 %r5, %r4, 1;
    setp.eq.u32 %p3, %r5, 1;
    @%p3 ret;
    mul.lo.u32 %r20, %r20, 2;
    ret;
)";
ControlWords call(uint32_t thread) {
  const auto inner = [&](uint32_t x) { return thread % 2 ? x : 2 * x; };
  uint32_t value = thread;
  if (thread < 20) value += 1000;
  if (thread >= 5 && thread < 20) value = inner(value) + 1;
  return {inner(value), 0xffff'ffff};
}

// Each lane hands its number to a function and takes the answer from the same place, at the start of the
// function's frame.
std::string call_function(std::string_view number) {
  return std::string(R"(
    add.u32 %r0, %r0, 16;
    st.local.b32 [%r0], %r4;
    setp.lt.u32 %p1, %r4, 28;
    rem.u32 %r5, %r4, 3;
    mad.lo.u32 %r5, %r5, 2, 1;
    @%p1 call.function )") +
         std::string(number) + R"(;
    ld.local.b32 %r20, [%r0];
    sub.u32 %r0, %r0, 16;
    mov.b32 %r4, %tid.x;
    ld.param.b64 %rd2, [0];
    mad.wide.u32 %rd22, %r4, 8, %rd2;
    activemask.b32 %r21;
)";
}
const std::vector<std::string> kCalledFunctions = {
    // This one doubles, but for small numbers.
    R"(.function 1
.local_bytes 16
    ld.local.b32 %r5, [%r0];
    setp.lt.u32 %p1, %r5, 6;
    @%p1 ret;
    shl.b32 %r5, %r5, 1;
    st.local.b32 [%r0], %r5;
    ret;
)",
    // This one sums all numbers up to its own: it calls itself.
    R"(.function 3
.local_bytes 16
    ld.local.b32 %r5, [%r0];
    setp.eq.u32 %p1, %r5, 0;
    @%p1 ret;
    st.local.b32 [%r0 + 4], %r5;
    sub.u32 %r5, %r5, 1;
    add.u32 %r0, %r0, 16;
    st.local.b32 [%r0], %r5;
    call.function 3;
    ld.local.b32 %r6, [%r0];
    sub.u32 %r0, %r0, 16;
    ld.local.b32 %r5, [%r0 + 4];
    add.u32 %r5, %r5, %r6;
    st.local.b32 [%r0], %r5;
    ret;
)",
    // This one calls the first one, and adds 1000.
    R"(.function 5
.local_bytes 16
    ld.local.b32 %r5, [%r0];
    add.u32 %r0, %r0, 16;
    st.local.b32 [%r0], %r5;
    call.function 1;
    ld.local.b32 %r6, [%r0];
    sub.u32 %r0, %r0, 16;
    add.u32 %r6, %r6, 1000;
    st.local.b32 [%r0], %r6;
    ret;
)"};
ControlWords called_function(uint32_t thread) {
  const uint32_t doubled = thread < 6 ? thread : 2 * thread;
  const uint32_t answers[] = {doubled, thread * (thread + 1) / 2, doubled + 1000};
  return {thread < 28 ? answers[thread % 3] : thread, 0xffff'ffff};
}

constexpr const char* kExit = R"(
    and.b32 %r5, %r4, 1;
    setp.eq.u32 %p1, %r5, 1;
    @%p1 exit;
    activemask.b32 %r20;
    setp.ge.u32 %p1, %r4, 16;
    ssy REST;
    @!%p1 bra REST;
    exit;
REST:
    join;
    activemask.b32 %r21;
)";
ControlWords leave(uint32_t thread) {
  // What has ended leaves the words as they were.
  if (thread % 2 || thread >= 16) return {0, 0};
  return {0x5555'5555, 0x0000'5555};
}

constexpr const char* kActive = R"(
    activemask.b32 %r20;
    mov.b32 %r21, 0;
    setp.lt.u32 %p1, %r4, 11;
    @%p1 activemask.b32 %r21;
)";
ControlWords active(uint32_t thread) {
  return {0xffff'ffff, thread < 11 ? 0x7ffu : 0};
}

// Each thread of four warps writes its number where a thread of another warp reads it.
constexpr const char* kMeet = R"(
    shl.b32 %r5, %r4, 2;
    mad.lo.u32 %r6, %r4, %r4, 7;
    st.shared.b32 [%r5], %r6;
    bar.sync 2, 0;
    xor.b32 %r7, %r5, 384;
    ld.shared.b32 %r20, [%r7];
    bar.sync 2, 128;
    st.shared.b32 [%r7], %r4;
    bar.sync 15, 128;
    ld.shared.b32 %r21, [%r5];
)";
ControlWords meet(uint32_t thread) {
  const uint32_t other = thread ^ 96;
  return {other * other + 7, other};
}

// The upper two warps write and arrive without waiting, and the lower two wait for all four.
constexpr const char* kArrive = R"(
    shl.b32 %r5, %r4, 2;
    mov.b32 %r20, 5;
    mov.b32 %r21, 6;
    setp.ge.u32 %p1, %r4, 64;
    ssy DONE;
    @!%p1 bra WAIT;
    add.u32 %r6, %r4, 1000;
    st.shared.b32 [%r5], %r6;
    bar.arrive 9, 128;
    bra DONE;
WAIT:
    bar.sync 9, 128;
    xor.b32 %r7, %r5, 256;
    ld.shared.b32 %r20, [%r7];
DONE:
    join;
)";
ControlWords arrive(uint32_t thread) {
  return {thread < 64 ? (thread ^ 64) + 1000 : 5, 6};
}

// Predicates that hold for some threads, for all, and for none.
std::string reduce(const std::string& op, bool is_count) {
  std::string text =
      "    rem.u32 %r5, %r4, 5;\n    setp.eq.u32 %p1, %r5, 2;\n    setp.ge.u32 %p2, %r4, 0;\n"
      "    setp.gt.u32 %p3, %r4, 500;\n";
  const std::string first = is_count ? "%r6" : "%p4", second = is_count ? "%r7" : "%p5",
                    third = is_count ? "%r8" : "%p6";
  text += "    " + op + " " + first + ", 0, 0, %p1;\n";
  text += "    " + op + " " + second + ", 1, 96, %p2;\n";
  text += "    " + op + " " + third + ", 0, 0, %p3;\n";
  if (!is_count)
    text += "    selp.b32 %r6, 1, 0, %p4;\n    selp.b32 %r7, 1, 0, %p5;\n    selp.b32 %r8, 1, 0, %p6;\n";
  return text + "    shl.b32 %r7, %r7, 8;\n    add.u32 %r20, %r6, %r7;\n    mov.b32 %r21, %r8;\n";
}
// Of 96 threads, 2, 7, ..., 92 give true first: 19 of them.
ControlWords count(uint32_t) {
  return {19 + (96 << 8), 0};
}
ControlWords all(uint32_t) {
  return {0 + (1 << 8), 0};
}
ControlWords any(uint32_t) {
  return {1 + (1 << 8), 0};
}

// Lanes of one warp pass words through memory. A fence stands between the store and the load.
std::string exchange(const std::string& fence) {
  return R"(
    shl.b32 %r5, %r4, 2;
    mad.lo.u32 %r6, %r4, 3, 11;
    st.shared.b32 [%r5], %r6;
    mad.wide.u32 %rd8, %r4, 4, %rd24;
    st.global.b32 [%rd8], %r6;
    )" + fence +
         R"(;
    xor.b32 %r7, %r4, 31;
    shl.b32 %r5, %r7, 2;
    ld.shared.b32 %r20, [%r5];
    mad.wide.u32 %rd8, %r7, 4, %rd24;
    ld.global.b32 %r21, [%rd8];
)";
}
ControlWords exchanged(uint32_t thread) {
  const uint32_t word = (thread ^ 31) * 3 + 11;
  return {word, word};
}

// Lane 3 sets the word for which the others wait, and its path comes last.
constexpr const char* kWait = R"(
    mov.b32 %r5, 0;
    st.shared.b32 [%r5], %r5;
    setp.eq.u32 %p1, %r4, 3;
    ssy MEET;
    @%p1 bra SET;
AGAIN:
    yield;
    ld.shared.b32 %r20, [%r5];
    setp.eq.u32 %p2, %r20, 0;
    @%p2 bra AGAIN;
    bra MEET;
SET:
    mov.b32 %r20, 7;
    st.shared.b32 [%r5], %r20;
MEET:
    join;
    add.u32 %r21, %r20, %r4;
)";

constexpr const char* kPrint = R"(
    setp.eq.u32 %p1, %r4, 3;
    setp.ge.u32 %p2, %r4, 30;
    neg.s32 %r5, %r4;
    @%p1 print 0, %r4, %r5, 0x40490fdb, 0;
    @%p2 print 1, 0x89abcdef, 1, %r4, 0;
    mov.b32 %r20, 1;
    mov.b32 %r21, 2;
)";
constexpr const char* kPrintPart = R"(
    setp.eq.u32 %p1, %r4, 3;
    setp.ge.u32 %p2, %r4, 30;
    neg.s32 %r5, %r4;
    @%p2 print.part 1, 0x89abcdef, 1, %r4, 0;
    @%p1 print.part 0, %r4, %r5, 0x40490fdb, 0;
    @%p2 print.part 0, %r4, %r5, 0x3f800000, 0;
    @%p2 print 2, 0, 0, 0, 0;
    @%p1 print 2, 0, 0, 0, 0;
    mov.b32 %r20, 1;
    mov.b32 %r21, 2;
)";
constexpr const char* kMessages = R"(
.message 0 "<%u %d %.3f>"
.message 1 "%lx;%o|"
.message 2 "end"
)";
ControlWords printed(uint32_t) {
  return {1, 2};
}

std::vector<ControlCase> make_cases() {
  const std::string trap =
      "    setp.gt.u32 %p1, %r4, 40;\n    @%p1 trap;\n    mov.b32 %r20, 8;\n    mov.b32 %r21, 9;\n";
  return {
      {"bra", 64, kLoop, &loop},
      {"ssy", 64, kRegions, &regions},
      {"join", 64, kRegions, &regions},
      {"brx.idx", 32, kTable, &table},
      {"call", 32, kCall, &call, "", "", kFunctions},
      {"ret", 32, kCall, &call, "", "", kFunctions},
      {"call.function", 32, call_function("%r5"), &called_function, "", "", "", "", kCalledFunctions},
      {"call.function", 32, call_function("0"), nullptr, "calls through a null address", "", "", "",
       kCalledFunctions},
      {"call.function", 32, call_function("4"), nullptr,
       "calls through the address 0x4, where no function begins", "", "", "", kCalledFunctions},
      {"exit", 32, kExit, &leave},
      {"activemask.b32", 32, kActive, &active},
      // A trap whose guard no lane passes does nothing.
      {"trap", 32, trap,
       [](uint32_t) {
         return ControlWords{8, 9};
       }},
      {"trap", 64, trap, nullptr, "stops itself with a trap"},
      {"bar.sync", 128, kMeet, &meet},
      {"bar.arrive", 128, kArrive, &arrive},
      {"bar.red.popc.u32", 96, reduce("bar.red.popc.u32", true), &count},
      {"bar.red.and.pred", 96, reduce("bar.red.and.pred", false), &all},
      {"bar.red.or.pred", 96, reduce("bar.red.or.pred", false), &any},
      {"bar.warp.sync", 32, exchange("bar.warp.sync 0xffffffff"), &exchanged},
      {"membar.cta", 32, exchange("membar.cta"), &exchanged},
      {"membar.gl", 32, exchange("membar.gl"), &exchanged},
      {"membar.sys", 32, exchange("membar.sys"), &exchanged},
      {"yield", 32, kWait,
       [](uint32_t thread) {
         return ControlWords{7, 7 + thread};
       }},
      {"print", 32, kPrint, &printed, "", "<3 -3 3.142>\n189abcdef;36|\n189abcdef;37|\n", "", kMessages},
      {"print.part", 32, kPrintPart, &printed, "",
       "<3 -3 3.142>end\n189abcdef;36|<30 -30 1.000>end\n189abcdef;37|<31 -31 1.000>end\n", "", kMessages},
  };
}

}  // namespace

const std::vector<ControlCase>& control_cases() {
  static const std::vector<ControlCase> cases = [] {
    std::vector<ControlCase> all = make_cases();
    for (ControlCase& test : async_cases()) all.push_back(std::move(test));
    return all;
  }();
  return cases;
}

}  // namespace glint::test
