// Lists programs for copies to shared memory and barriers there. The expected words are plain C++ for one
// thread.
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/ops/control_cases.h"

namespace glint::test {
namespace {

// Waits until the question in `ask`, whose answer is %p2, is true.
std::string until(const std::string& ask, const std::string& label) {
  return "    ssy " + label + "_DONE;\n" + label + ":\n    " + ask + "\n    @%p2 bra " + label +
         "_DONE;\n    bra " + label + ";\n" + label + "_DONE:\n    join;\n";
}
// Makes a barrier at shared address 64 for `count` arrivals a phase.
std::string barrier_for(int count) {
  return "    setp.eq.u32 %p1, %r4, 0;\n    @%p1 mbarrier.init.shared.b64 [64], " + std::to_string(count) +
         ";\n    bar.sync 0, 0;\n";
}

// Each thread leaves a word and takes that of its opposite when all have arrived.
constexpr const char* kLeave = R"(
    mul.lo.u32 %r5, %r4, 3;
    mad.lo.u32 %r6, %r4, 4, 128;
    st.shared.b32 [%r6], %r5;
)";
constexpr const char* kTake = R"(
    sub.u32 %r7, 63, %r4;
    mad.lo.u32 %r7, %r7, 4, 128;
    ld.shared.b32 %r20, [%r7];
    selp.b32 %r21, 1, 0, %p2;
)";
std::string meet_at(const std::string& ask) {
  return barrier_for(64) + kLeave + "    mbarrier.arrive.shared.b64 %rd8, [64], 1;\n" + until(ask, "WAIT") +
         kTake;
}
ControlWords taken(uint32_t thread) {
  return {(63 - thread) * 3, 1};
}

// In the first phase the lanes of warp 0 arrive twice and leave, and in the second those of warp 1 are alone.
const std::string kDrop = barrier_for(96) + R"(
    setp.lt.u32 %p1, %r4, 32;
    @%p1 mbarrier.arrive_drop.shared.b64 %rd8, [64], 2;
    @!%p1 mbarrier.arrive.shared.b64 %rd8, [64], 1;
)" + until("mbarrier.try_wait.parity.shared.b64 %p2, [64], 0;", "FIRST") +
                          R"(
    @!%p1 mbarrier.arrive.shared.b64 %rd8, [64], 1;
)" + until("mbarrier.try_wait.parity.shared.b64 %p2, [64], 1;", "SECOND") +
                          R"(
    mbarrier.test_wait.parity.shared.b64 %p3, [64], 0;
    mov.b32 %r20, 7;
    selp.b32 %r21, 1, 0, %p3;
)";
ControlWords dropped(uint32_t) {
  return {7, 0};  // The third phase has even parity, and has not ended.
}

// Bytes that were a barrier hold a number.
const std::string kInval = barrier_for(1) + R"(
    bar.sync 0, 0;
    @%p1 mbarrier.inval.shared.b64 [64];
    @%p1 st.shared.b32 [64], 5;
    bar.sync 0, 0;
    ld.shared.b32 %r20, [64];
    mov.b32 %r21, 6;
)";

// Each thread copies a word that it has stored and added to, and takes that of its opposite.
constexpr const char* kCopy = R"(
    mul.lo.u32 %r5, %r4, 3;
    mad.wide.u32 %rd10, %r4, 4, %rd24;
    st.global.b32 [%rd10], 0;
    red.global.add.u32 [%rd10], %r5;
    mad.lo.u32 %r6, %r4, 4, 128;
    cp.async.b32 %r6, [%rd10], 4;
)";
// Clears what the threads have exchanged in global memory.
constexpr const char* kClear = "    st.global.b32 [%rd10], 0;\n";
std::string copy_and(const std::string& arrive, int count) {
  return barrier_for(count) + kCopy + arrive +
         until("mbarrier.try_wait.parity.shared.b64 %p2, [64], 0;", "WAIT") + kTake + "    bar.sync 0, 0;\n" +
         kClear;
}
std::string copy_in_groups() {
  return std::string(kCopy) +
         "    cp.async.commit_group;\n    cp.async.commit_group;\n    cp.async.wait_group 1;\n    bar.sync "
         "0, 0;\n"
         "    setp.eq.u32 %p2, %r4, %r4;\n" +
         kTake + "    bar.sync 0, 0;\n" + kClear;
}

}  // namespace

std::vector<ControlCase> async_cases() {
  const std::string by_state = meet_at("mbarrier.test_wait.shared.b64 %p2, [64], %rd8;");
  const std::string arrive = "    mbarrier.arrive.shared.b64 %rd8, [64], 1;\n";
  // These end in a fault before they leave their words.
  const std::string words = "    mov.b32 %r20, 0;\n    mov.b32 %r21, 0;\n";
  const std::string unknown = words + "    mbarrier.arrive.shared.b64 %rd8, [64], 1;\n";
  return {
      {"mbarrier.init.shared.b64", 64, by_state, &taken},
      {"mbarrier.init.shared.b64", 32, words + "    mbarrier.init.shared.b64 [64], 0;\n", nullptr,
       "makes an mbarrier for 0 arrivals, expected 1 to 1048575"},
      {"mbarrier.init.shared.b64", 32, words + "    mbarrier.init.shared.b64 [68], 1;\n", nullptr,
       "changes 8 bytes at shared address 0x44, which is not a multiple of 8"},
      {"mbarrier.init.shared.b64", 32,
       words + "    mov.b32 %r5, 1024;\n    mbarrier.init.shared.b64 [%r5], 1;\n", nullptr,
       "changes 8 bytes at shared address 0x400: 0 bytes past the end of the block's shared memory"},
      {"mbarrier.arrive.shared.b64", 64, by_state, &taken},
      {"mbarrier.arrive.shared.b64", 32, unknown, nullptr,
       "uses an mbarrier that mbarrier.init has not made"},
      {"mbarrier.arrive.shared.b64", 32,
       words + barrier_for(4) + "    mbarrier.arrive.shared.b64 %rd8, [64], 5;\n", nullptr,
       "arrives 5 times at an mbarrier whose phase waits for 4 arrivals"},
      {"mbarrier.arrive_drop.shared.b64", 64, kDrop, &dropped},
      {"mbarrier.test_wait.shared.b64", 64, by_state, &taken},
      {"mbarrier.test_wait.parity.shared.b64", 64,
       meet_at("mbarrier.test_wait.parity.shared.b64 %p2, [64], 0;"), &taken},
      {"mbarrier.try_wait.shared.b64", 64, meet_at("mbarrier.try_wait.shared.b64 %p2, [64], %rd8;"), &taken},
      {"mbarrier.try_wait.parity.shared.b64", 64, kDrop, &dropped},
      {"mbarrier.inval.shared.b64", 64, kInval,
       [](uint32_t) {
         return ControlWords{5, 6};
       }},
      {"mbarrier.inval.shared.b64", 32,
       barrier_for(2) + "    @%p1 mbarrier.inval.shared.b64 [64];\n" + unknown, nullptr,
       "or that mbarrier.inval has ended"},
      {"cp.async.mbarrier.arrive.shared.b64", 64,
       copy_and("    cp.async.mbarrier.arrive.shared.b64 [64];\n" + arrive, 64), &taken},
      {"cp.async.mbarrier.arrive.noinc.shared.b64", 64,
       copy_and("    cp.async.mbarrier.arrive.noinc.shared.b64 [64];\n" + arrive, 128), &taken},
      {"cp.async.commit_group", 64, copy_in_groups(), &taken},
      {"cp.async.wait_group", 64, copy_in_groups(), &taken},
  };
}

}  // namespace glint::test
