// Tests that every registered child order keeps the promises of rtunit/child_order.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <utility>

#include "base/registry.h"
#include "rtunit/child_order.h"
#include "rtunit/node_format.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

using Order = std::vector<uint8_t>;

// Holds children by distance, kind and box, in index order.
struct Hits {
  std::vector<float> t;
  std::vector<NodeRef> child;
  std::vector<uint8_t> slot;
  std::vector<Bounds> box;
  uint32_t octant = 0;
  bool ends_at_first_hit = false;
  Order sorted(const ChildOrder& order) const {
    Order out(t.size(), 0xee);
    const RayState state{};
    const RayView ray{state.ray, state.space, 1, ends_at_first_hit};
    const auto* node = reinterpret_cast<const std::byte*>(box.data());
    const auto read = [](const ChildHits& hits, Bounds* boxes) {
      std::copy_n(reinterpret_cast<const Bounds*>(hits.node), hits.count, boxes);
    };
    order.sort({int(t.size()), t.data(), child.data(), slot.data(), octant, &ray, node, read}, out.data());
    return out;
  }
  void add(float distance, NodeRef node, float side) {
    t.push_back(distance);
    slot.push_back(uint8_t(child.size()));
    child.push_back(node);
    box.push_back({{0, 0, 0}, {side, side, side}});
  }
};
Hits hits(std::initializer_list<std::pair<float, NodeKind>> children) {
  Hits out;
  for (const auto& [t, kind] : children) out.add(t, node_ref(uint32_t(out.child.size() + 9), kind), 1);
  return out;
}

Order order_of(const char* name, const Hits& of) {
  return of.sorted(*Registry<ChildOrder>::instance().entry(name).make_default({}));
}

constexpr NodeKind kNode = NodeKind::Internal, kLeaf = NodeKind::Triangle;

TEST_CASE("every child order names each child once, and says the same when asked again") {
  const auto names = Registry<ChildOrder>::names();
  REQUIRE(names.size() >= 5);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto order = Registry<ChildOrder>::instance().entry(name).make_default({});
    Random random{4};
    for (int i = 0; i < 2000; ++i) {
      Hits some;
      for (uint32_t n = random.below(9); n; --n) {
        const float t = float(random.below(4)), side = float(random.below(3));
        some.add(t, node_ref(random.below(1000), random.below(2) ? kNode : kLeaf), side);
      }
      some.octant = random.below(8);
      some.ends_at_first_hit = random.below(2);
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

TEST_CASE(
    "largest_first goes by area for rays that end at any hit, of equals the nearer; others go by distance") {
  Hits some;
  for (const auto& [t, side] : {std::pair{1.f, 1.f}, {4.f, 3.f}, {3.f, 2.f}, {2.f, 3.f}, {2.f, 3.f}})
    some.add(t, node_ref(uint32_t(some.child.size() + 9), kNode), side);
  CHECK(order_of("largest_first", some) == Order{0, 3, 4, 2, 1});
  some.ends_at_first_hit = true;
  CHECK(order_of("largest_first", some) == Order{3, 4, 1, 2, 0});
}

// Compares what the traversal shows with the node that the ray visits.
class OrderWitness final : public ChildOrder {
 public:
  OrderWitness(const NodeFormat& format, const RayState& ray) : format_(format), ray_(ray) {}
  void sort(const ChildHits& hits, uint8_t* order) const override {
    std::vector<DecodedChild> all(format_.width());
    all.resize(format_.decode(hits.node, all));
    std::vector<Bounds> boxes(size_t(hits.count));
    hits.boxes(boxes.data());
    for (int i = 0; i < hits.count; ++i) {
      const auto child = std::find_if(all.begin(), all.end(),
                                      [&](const DecodedChild& c) { return c.node == hits.child[i]; });
      REQUIRE(child != all.end());
      REQUIRE(child->bounds == boxes[size_t(i)]);
      ++seen;
    }
    REQUIRE(&hits.ray->ray == &ray_.ray);
    REQUIRE(&hits.ray->space == &ray_.space);
    REQUIRE(hits.ray->t_max == ray_.committed.t);
    ends = hits.ray->ends_at_first_hit;
    nearest_first(hits, order);
  }
  mutable int seen = 0;
  mutable bool ends = false;

 private:
  const NodeFormat& format_;
  const RayState& ray_;
};

TEST_CASE("in every node format, an order sees the boxes of the children that are hit, and the ray") {
  Random random{6};
  const Positions positions = soup(random, 3000, 10, 3);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    mem::AddressSpace memory;
    const StructureInfo top = single(memory, triangles(positions), {name.c_str()});
    for (const uint32_t flags : {0u, ray_flag::kTerminateOnFirstHit}) {
      RayState plain = ray_of(top.address, {0, 0, -30}, {0.01f, 0.02f, 1});
      plain.ray.flags = flags | ray_flag::kOpaque;
      RayState ray = plain;
      REQUIRE(begin(plain, memory));
      REQUIRE(begin(ray, memory));
      const auto format = make_format(name);
      const OrderWitness witness(*format, ray);
      ray.rules.order = &witness;
      run(plain, memory);
      run(ray, memory);
      CHECK(witness.seen > 10);
      CHECK(witness.ends == (flags != 0));
      CHECK(ray.nodes_visited == plain.nodes_visited);
      CHECK(ray.committed.t == plain.committed.t);
    }
  }
}

TEST_CASE("first_internal goes down the first internal child, then from the last child to the first") {
  CHECK(order_of("first_internal", hits({{3, kLeaf}, {1, kNode}, {2, kNode}, {0, kLeaf}})) ==
        Order{1, 3, 2, 0});
  CHECK(order_of("first_internal", hits({{3, kLeaf}, {1, kLeaf}})) == Order{1, 0});
}

}  // namespace
}  // namespace glint::rt::test
