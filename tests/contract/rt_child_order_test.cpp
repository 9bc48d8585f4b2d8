// Tests that every registered child order keeps the promises of rtunit/child_order.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <initializer_list>
#include <utility>

#include "base/registry.h"
#include "rtunit/child_order.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

using Order = std::vector<uint8_t>;

// Holds children by distance and kind, in index order.
struct Hits {
  std::vector<float> t;
  std::vector<NodeRef> child;
  std::vector<uint8_t> slot;
  uint32_t octant = 0;
  Order sorted(const ChildOrder& order) const {
    Order out(t.size(), 0xee);
    order.sort({int(t.size()), t.data(), child.data(), slot.data(), octant}, out.data());
    return out;
  }
};
Hits hits(std::initializer_list<std::pair<float, NodeKind>> children) {
  Hits out;
  for (const auto& [t, kind] : children) {
    out.t.push_back(t);
    out.slot.push_back(uint8_t(out.child.size()));
    out.child.push_back(node_ref(uint32_t(out.child.size() + 9), kind));
  }
  return out;
}

Order order_of(const char* name, const Hits& of) {
  return of.sorted(*Registry<ChildOrder>::instance().entry(name).make_default({}));
}

constexpr NodeKind kNode = NodeKind::Internal, kLeaf = NodeKind::Triangle;

TEST_CASE("every child order names each child once, and says the same when asked again") {
  const auto names = Registry<ChildOrder>::names();
  REQUIRE(names.size() >= 4);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto order = Registry<ChildOrder>::instance().entry(name).make_default({});
    Random random{4};
    for (int i = 0; i < 2000; ++i) {
      Hits some;
      for (uint32_t n = random.below(9); n; --n) {
        some.t.push_back(float(random.below(4)));
        some.slot.push_back(uint8_t(some.child.size()));
        some.child.push_back(node_ref(random.below(1000), random.below(2) ? kNode : kLeaf));
      }
      some.octant = random.below(8);
      const Order first = some.sorted(*order);
      REQUIRE(first == some.sorted(*order));
      Order seen = first;
      std::sort(seen.begin(), seen.end());
      for (size_t at = 0; at < seen.size(); ++at) REQUIRE(seen[at] == at);
    }
  }
}

TEST_CASE("near_first is by distance, of equals the lower; and it is what the traversal has compiled in") {
  const Hits some = hits({{3, kNode}, {1, kLeaf}, {2, kNode}, {1, kNode}});
  CHECK(order_of("near_first", some) == Order{1, 3, 2, 0});
  CHECK(Registry<ChildOrder>::instance().entry("near_first").make_default({})->for_rays() == nullptr);
}

TEST_CASE("index_order is that of the node") {
  CHECK(order_of("index_order", hits({{3, kNode}, {1, kLeaf}, {2, kNode}})) == Order{0, 1, 2});
}

TEST_CASE("octant goes by slots and by the signs of the direction, whatever the distances") {
  Hits some = hits({{3, kNode}, {1, kLeaf}, {2, kNode}, {0, kNode}});
  some.slot = {0, 1, 3, 6};
  CHECK(order_of("octant", some) == Order{0, 1, 2, 3});
  some.octant = 7;
  CHECK(order_of("octant", some) == Order{3, 2, 1, 0});
  some.octant = 1;  // It goes down the x axis: the upper of two slots that differ in x comes first.
  CHECK(order_of("octant", some) == Order{1, 0, 2, 3});
}

TEST_CASE("first_internal goes down the first internal child, then from the last child to the first") {
  CHECK(order_of("first_internal", hits({{3, kLeaf}, {1, kNode}, {2, kNode}, {0, kLeaf}})) ==
        Order{1, 3, 2, 0});
  CHECK(order_of("first_internal", hits({{3, kLeaf}, {1, kLeaf}})) == Order{1, 0});
}

}  // namespace
}  // namespace glint::rt::test
