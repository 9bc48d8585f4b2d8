// Tests the promises of Reorder for every registered policy, and what each policy is for.
// SPDX-License-Identifier: Apache-2.0
#include "core/reorder.h"

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/params.h"
#include "tests/support/catch.h"

namespace glint::core {
namespace {

using Call = exec::ReorderCall;
using Found = Call::Found;

std::unique_ptr<Reorder> made_reorder(const std::string& name) {
  return PolicyChoice<Reorder>(name.c_str()).make({});
}

}  // namespace

TEST_CASE("every reordering gives a call the same key each time, and decides alike for the same warps") {
  for (const std::string& name : Registry<Reorder>::names()) {
    CAPTURE(name);
    const auto one = made_reorder(name), two = made_reorder(name);
    CHECK(one->where() == two->where());
    std::mt19937 random(7);
    std::vector<Call> calls(500);
    std::vector<uint64_t> keys;
    for (Call& call : calls) {
      call = {Found(random() % 4), uint32_t(random() % 9), uint32_t(random() % 8), 3};
      keys.push_back(one->key(call));
    }
    for (size_t i = calls.size(); i-- > 0;) REQUIRE(two->key(calls[i]) == keys[i]);
    for (uint32_t batch : {1u, 8u, 64u})
      for (uint32_t warps = 1; warps <= 64; ++warps) {
        const Reorder::Waiting waiting{warps, warps * 20, batch};
        REQUIRE(one->goes(waiting) == two->goes(waiting));
      }
  }
}

TEST_CASE(
    "the default is that threads stay where they are, and other reorderings have a place where warps come") {
  const std::vector<std::string> names = Registry<Reorder>::names();
  CHECK(names.size() >= 3);
  for (const std::string& name : names)
    CHECK((made_reorder(name)->where() == Reorder::Where::Nowhere) == (name == Params{}.reorder.name));
}

TEST_CASE("sort keeps records together, and within them hints") {
  const auto sort = made_reorder("sort");
  const auto key = [&](Found found, uint32_t record, uint32_t hint) {
    return sort->key({found, record, hint, 8});
  };
  CHECK(key(Found::Hit, 3, 5) == key(Found::Hit, 3, 5));
  CHECK(key(Found::Hit, 3, 200) < key(Found::Hit, 4, 0));
  CHECK(key(Found::Hit, 3, 1) < key(Found::Hit, 3, 2));
  CHECK(key(Found::Hit, 3, 1) != key(Found::Miss, 3, 1));
  CHECK(key(Found::Nothing, 0, 1) != key(Found::Hint, 0, 1));
  CHECK(sort->where() == Reorder::Where::Calls);
}

TEST_CASE("by_shader_record does not look at hints") {
  const auto by_record = made_reorder("by_shader_record");
  CHECK(by_record->key({Found::Hit, 3, 1, 8}) == by_record->key({Found::Hit, 3, 2, 8}));
  CHECK(by_record->key({Found::Hit, 3, 1, 8}) != by_record->key({Found::Hit, 2, 1, 8}));
  CHECK(by_record->key({Found::Hit, 3, 0, 0}) != by_record->key({Found::Miss, 3, 0, 0}));
  CHECK(by_record->where() == Reorder::Where::Traces);
}

}  // namespace glint::core
