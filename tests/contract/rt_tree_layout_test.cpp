// Tests that every registered tree layout keeps the promises of rtunit/tree_layout.h.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/registry.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/build_tree.h"
#include "rtunit/structure/validate.h"
#include "rtunit/treelets.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"

namespace glint::rt::test {
namespace {

BuildOptions options_of(const std::string& format, const std::string& layout) {
  return {format.c_str(), true, layout.c_str()};
}

BuildTree tree_of(uint32_t width, uint32_t leaves, uint64_t seed) {
  Random random{seed};
  mem::HostArray<BuildItem> items(leaves);
  for (uint32_t i = 0; i < leaves; ++i) {
    const auto low = random.point(10);
    items[i] = {{low, {low[0] + 1, low[1] + 1, low[2] + 1}},
                random.below(4) ? NodeKind::Triangle : NodeKind::Instance,
                i * 2 * kLeafBytes / kBlockBytes};
  }
  BuildTree tree;
  build_tree({items.data(), items.size()}, width, 1, tree);
  return tree;
}

TEST_CASE("a treelet hangs together below its root, fits its size, and no node is left out") {
  uint32_t with_treelets = 0;
  for (const std::string& name : Registry<TreeLayout>::names())
    for (const uint32_t leaves : {0u, 1u, 2u, 40u, 3000u}) {
      CAPTURE(name, leaves);
      const auto layout = Registry<TreeLayout>::instance().entry(name).make_default({});
      const BuildTree tree = tree_of(6, leaves, 5);
      const NodeOrder order = layout->order(tree, 64), again = layout->order(tree, 64);
      REQUIRE(order.nodes == again.nodes);
      REQUIRE(order.first == again.first);
      REQUIRE(layout->forms_treelets() == !order.first.empty());
      with_treelets += layout->forms_treelets();
      if (!order.nodes.empty()) {
        REQUIRE(order.nodes.size() == tree.nodes.size());
        REQUIRE(std::set<uint32_t>(order.nodes.begin(), order.nodes.end()).size() == tree.nodes.size());
      }
      if (order.first.empty()) continue;
      std::vector<uint32_t> parent(tree.nodes.size());
      for (uint32_t n = 0; n < tree.nodes.size(); ++n)
        if (tree.nodes[n].kind == NodeKind::Internal)
          for (const uint32_t child : children_of(tree, tree.nodes[n])) parent[child] = n;
      REQUIRE(order.first.front() == 0);
      for (size_t t = 0; t < order.first.size(); ++t) {
        const size_t end = t + 1 < order.first.size() ? order.first[t + 1] : order.nodes.size();
        REQUIRE(order.first[t] < end);
        std::set<uint32_t> members;
        uint32_t bytes = 0;
        for (size_t i = order.first[t]; i < end; ++i) {
          const uint32_t n = order.nodes[i];
          if (!members.empty()) REQUIRE(members.contains(parent[n]));
          members.insert(n);
          bytes += bytes_of(tree.nodes[n], 64);
        }
        REQUIRE((bytes <= 512 || members.size() == 1));
      }
    }
  CHECK(with_treelets == 10);
}

TEST_CASE("structures of every layout are sound, and their rays find the same hits") {
  const Scene scene = crowd(3, 60);
  for (const std::string& format : Registry<NodeFormat>::names()) {
    const BuiltScene plain(scene, options_of(format, "depth_first"));
    for (const std::string& name : Registry<TreeLayout>::names()) {
      CAPTURE(format, name);
      const BuiltScene built(scene, options_of(format, name));
      for (const std::string& error : validate(built.memory, built.top.address)) FAIL_CHECK(error);
      Random random{9};
      uint32_t hits = 0;
      for (int i = 0; i < 400; ++i) {
        const auto origin = random.point(15), direction = random.point(1);
        RayState a = ray_of(plain.top.address, origin, direction),
                 b = ray_of(built.top.address, origin, direction);
        REQUIRE(begin(a, plain.memory));
        REQUIRE(begin(b, built.memory));
        run_to_end(a, plain.memory);
        run_to_end(b, built.memory);
        REQUIRE(std::memcmp(&a.committed.t, &b.committed.t, 12) == 0);
        REQUIRE(a.committed.instance == b.committed.instance);
        REQUIRE(a.committed.primitive == b.committed.primitive);
        REQUIRE(a.nodes_visited == b.nodes_visited);
        hits += a.committed.valid();
      }
      CHECK(hits > 100);
    }
  }
}

// Walks the structure of one bottom level by decoding its nodes, and asks the table of treelets about each.
TEST_CASE("the table of treelets names the treelet of every byte of every node") {
  Random random{2};
  const Positions positions = soup(random, 2000, 10, 1);
  for (const std::string& format_name : Registry<NodeFormat>::names())
    for (const std::string& name : Registry<TreeLayout>::names()) {
      CAPTURE(format_name, name);
      mem::AddressSpace memory;
      memory.allocate("something before it", 100);
      const StructureInfo info =
          build_bottom(memory, "b", {{triangles(positions)}}, options_of(format_name, name));
      const auto format = make_format(format_name);
      const bool has_treelets =
          Registry<TreeLayout>::instance().entry(name).make_default({})->forms_treelets();
      const Treelets treelets(memory);
      CHECK(treelets.of(info.address) == kNoTreelet);  // the header
      CHECK(treelets.of(info.address + info.bytes) == kNoTreelet);
      std::set<TreeletId> seen;
      std::set<Address> nodes, listed;
      std::vector<std::pair<uint32_t, TreeletId>> open{{kRootBlock, kNoTreelet}};
      while (!open.empty()) {
        const auto [block, above] = open.back();
        open.pop_back();
        const Address at = info.address + Address{block} * kBlockBytes;
        const TreeletId here = treelets.of(at);
        REQUIRE((here != kNoTreelet) == has_treelets);
        nodes.insert(at);
        seen.insert(here);
        std::vector<DecodedChild> children(format->width());
        children.resize(format->decode(memory.find(at, format->node_bytes()), children));
        for (const DecodedChild& child : children) {
          if (kind_of(child.node) == NodeKind::Internal) {
            open.emplace_back(block_of(child.node), here);
            continue;
          }
          const Address leaf = info.address + Address{block_of(child.node)} * kBlockBytes;
          nodes.insert(leaf);
          seen.insert(treelets.of(leaf));
          CHECK(treelets.of(leaf) == treelets.of(leaf + kLeafBytes - 1));
        }
      }
      if (!has_treelets) continue;
      uint32_t most = 0;
      for (const TreeletId treelet : seen) {
        uint32_t bytes = 0, count = 0;
        treelets.for_each_node(treelet, [&](const Fetch& node) {
          CHECK(listed.insert(node.address).second);
          CHECK(treelets.of(node.address) == treelet);
          CHECK(node.bytes == (node.kind == NodeKind::Internal ? format->node_bytes() : kLeafBytes));
          bytes += node.bytes;
          ++count;
        });
        CHECK((bytes <= 512 || count == 1));
        most = std::max(most, count);
      }
      CHECK(listed == nodes);
      CHECK(most > 2);
      CHECK(seen.size() < nodes.size());
    }
}

TEST_CASE("breadth-first treelets take whole levels while they fit") {
  const BuildTree tree = tree_of(2, 64, 7);
  const auto layout = Registry<TreeLayout>::instance().entry("treelet_breadth_first").make_default({});
  const NodeOrder order = layout->order(tree, 64);
  // Of 64 B nodes, the first treelet of 512 B holds the eight nodes that a walk by levels meets first.
  std::vector<uint32_t> levels{0};
  for (size_t i = 0; levels.size() < 8; ++i)
    for (const uint32_t child : children_of(tree, tree.nodes[levels[i]])) levels.push_back(child);
  levels.resize(8);
  REQUIRE(order.first.size() > 1);
  uint32_t bytes = 0, fitting = 0;
  for (const uint32_t n : levels) fitting += (bytes += bytes_of(tree.nodes[n], 64)) <= 512;
  REQUIRE(order.first[1] == fitting);
  CHECK(std::equal(levels.begin(), levels.begin() + fitting, order.nodes.begin()));
}

TEST_CASE("treelets cut by cost are entered less often than treelets of whole levels") {
  const BuildTree tree = tree_of(6, 5000, 11);
  const auto cost_of = [&](const char* name) {
    const NodeOrder order = Registry<TreeLayout>::instance().entry(name).make_default({})->order(tree, 64);
    double area = 0;
    for (const uint32_t first : order.first) area += half_area(tree.nodes[order.nodes[first]].bounds);
    return area;
  };
  CHECK(cost_of("treelet_cost") < cost_of("treelet_breadth_first"));
}

}  // namespace
}  // namespace glint::rt::test
