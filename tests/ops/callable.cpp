// Checks calls of callable shaders: which record each lane calls, with which data, also from a callable.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <string>
#include <vector>

#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/ops/ray_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// These are the places of the shaders.
enum CallableShader : uint32_t { kTriples = 1, kAdds, kCalls };
constexpr uint32_t kNobody = exec::kNoShader;
constexpr uint32_t kCallableOf[] = {kTriples, kCalls, kAdds, kNobody, kCalls, kAdds, kTriples};
constexpr uint32_t kCallableRecords = std::size(kCallableOf);

// Names the words of a callable's data. The caller fills in the first two.
enum DataWord : uint32_t { kValue, kNextRecord, kWho, kOwnRecord, kAnswer, kDataWords };
// A callable that calls keeps the data of its callee here.
constexpr uint32_t kNextData = 32;

std::string answer(CallableShader who) {
  return fmt::format(
      "    pack.b64 %rd6, %record, %record_hi;\n    ld.global.b32 %r9, [%rd6];\n"
      "    st.local.b32 [%payload + {}], {};\n    st.local.b32 [%payload + {}], %r9;\n"
      "    st.local.b32 [%payload + {}], %r8;\n    ret;\n",
      4 * uint32_t(kWho), uint32_t(who), 4 * uint32_t(kOwnRecord), 4 * uint32_t(kAnswer));
}
std::string calculates(CallableShader who, std::string_view how) {
  return fmt::format("    ld.local.b32 %r8, [%payload];\n    {};\n", how) + answer(who);
}
// Passes its value plus one to the next record, and answers with that callable's answer times seven plus its
// number.
std::string calls() {
  return fmt::format(
             "    ld.local.b32 %r8, [%payload];\n    add.u32 %r8, %r8, 1;\n"
             "    st.local.b32 [%r0 + {0}], %r8;\n    st.local.b32 [%r0 + {1}], 0;\n    add.u32 %r9, %r0, "
             "{0};\n"
             "    ld.local.b32 %r8, [%payload + {2}];\n    add.u32 %r0, %r0, {3};\n"
             "    call.sbt.callable %r8, %r9;\n    sub.u32 %r0, %r0, {3};\n"
             "    ld.local.b32 %r8, [%r0 + {4}];\n    ld.local.b32 %r9, [%r0 + {1}];\n"
             "    mad.lo.u32 %r8, %r8, 7, %r9;\n",
             kNextData, kNextData + 4 * kWho, 4 * uint32_t(kNextRecord), RayLab::kFrameBytes,
             kNextData + 4 * kAnswer) +
         answer(kCalls);
}

// The inputs are the record, whether the thread calls, and the first two words of the data.
std::string caller() {
  constexpr uint32_t kData = 48;
  std::string out;
  for (uint32_t i = 0; i < 4; ++i)
    out += fmt::format("    ld.global.b32 %r{}, [%rd2 + {}];\n", 10 + i, 4 * i);
  for (uint32_t i = 0; i < kDataWords; ++i)
    out += fmt::format("    st.local.b32 [{}], {};\n", kData + 4 * i,
                       i < 2 ? fmt::format("%r{}", 12 + i) : std::to_string(RayLab::kUnwritten));
  out += fmt::format(
             "    mov.b32 %r8, {};\n    add.u32 %r0, %r0, {};\n    setp.ne.u32 %p1, %r11, 0;\n"
             "    @%p1 call.sbt.callable %r10, %r8;\n",
             kData, RayLab::kFrameBytes) +
         own_words();
  for (uint32_t i = 0; i < kDataWords; ++i)
    out += fmt::format("    ld.local.b32 %r9, [{}];\n", kData + 4 * i) + log_word(i, "%r9");
  return out + "    exit;\n";
}

struct Answer {
  uint32_t who = 0, answer = 0;
};
// Returns what the record answers to a value, when it calls `next` if it calls.
Answer answer_of(uint32_t record, uint32_t value, uint32_t next) {
  switch (kCallableOf[record]) {
    case kTriples:
      return {kTriples, value * 3};
    case kAdds:
      return {kAdds, value + 1000};
    case kCalls: {
      const Answer inner = answer_of(next, value + 1, 0);
      return {kCalls, inner.answer * 7 + inner.who};
    }
    default:
      return {};
  }
}

uint32_t random_record(Random& random, bool may_call) {
  for (;;) {
    const uint32_t record = random.below(kCallableRecords);
    if (kCallableOf[record] != kNobody && (may_call || kCallableOf[record] != kCalls)) return record;
  }
}

uint64_t check_calls(RayLab& lab, const isa::OpRow& row, bool one_record) {
  Random random{3};
  ThreadWords inputs, expected;
  uint64_t callers = 0;
  for (size_t t = 0; t < kThreads; ++t) {
    const bool is_null = !one_record && random.below(6) == 0, enabled = random.below(8) != 0;
    const uint32_t record = is_null ? 3 : random_record(random, true), next = random_record(random, false),
                   value = uint32_t(random.next()), called = one_record ? 0 : record;
    inputs.push_back({record, uint32_t(enabled), value, next});
    std::vector<uint32_t> log(RayLab::kLogWords, RayLab::kUnwritten);
    log[kValue] = value, log[kNextRecord] = next;
    callers += enabled;
    if (enabled && !is_null) {
      const Answer answer = answer_of(called, value, next);
      log[kWho] = answer.who, log[kAnswer] = answer.answer;
      log[kOwnRecord] = record_word(Region::Callable, called);
      callers += answer.who == kCalls;
    }
    expected.push_back(log);
  }
  const RayLab::Outcome outcome = lab.run(row, inputs);
  for (size_t t = 0; t < kThreads; ++t) {
    INFO("thread " << t << " calls record " << inputs[t][0]);
    CHECK(outcome.log[t] == expected[t]);
  }
  CHECK(outcome.lanes == callers);
  return outcome.lanes;
}

}  // namespace

uint64_t check_callable(const isa::OpRow& row) {
  RayLab lab({{"ray_generation", caller()},
              {"callable", calculates(kTriples, "mul.lo.u32 %r8, %r8, 3")},
              {"callable", calculates(kAdds, "add.u32 %r8, %r8, 1000")},
              {"callable", calls()}});
  lab.world.callable.assign(std::begin(kCallableOf), std::end(kCallableOf));
  lab.world.max_callable_depth = 2;
  lab.place_table();
  const uint64_t lanes = check_calls(lab, row, false);
  lab.world.table.callable.stride = 0;
  return lanes + check_calls(lab, row, true);
}

}  // namespace glint::test
