// Tests that every registered prefetcher keeps the promises of rtunit/prefetcher.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/config.h"
#include "base/diagnostics.h"
#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

struct Outcome {
  std::vector<Address> prefetched;  // physical addresses, in order
  std::string stats;
  std::vector<WarpRays> rays;
};

// Traces six warps of random rays with a prefetcher.
Outcome trace(const std::string& prefetcher, const mem::AddressSpace& memory, const StructureInfo& top,
              bool every_cycle) {
  Params params;
  params.prefetch.name = prefetcher;
  params.warps = 2;
  params.box.latency = 40;  // leaves the port free at times
  Random random{21};
  Outcome out;
  out.rays.resize(6);
  for (WarpRays& warp : out.rays)
    for (RayState& state : warp) {
      state = ray_of(top.address, random.point(12), random.point(1));
      REQUIRE(begin(state, memory));
    }
  stats::Group root(nullptr, "test");
  mem::FixedLatencyMemory l1(60, 1);
  RtUnit unit(params, {memory, l1, &root});
  const Launch done = launch(unit, l1, out.rays, every_cycle);
  REQUIRE(done.completions >= out.rays.size());
  unit.finish(done.last_completion + 1);
  for (const mem::Request& request : l1.log())
    if (request.traffic == mem::Traffic::RtPrefetch) {
      REQUIRE(mem::num_sectors(request.sectors) == 1);
      uint32_t sector = 0;
      while (!(request.sectors >> sector & 1)) ++sector;
      out.prefetched.push_back(request.line + Address{sector} * mem::kSectorBytes);
    }
  out.stats = glint::test::listing(root);
  return out;
}

TEST_CASE("a prefetcher changes no hit, repeats itself exactly and asks for memory that rays read") {
  Random random{8};
  const Positions positions = soup(random, 400, 10, 2);
  mem::AddressSpace memory;
  const StructureInfo top =
      single(memory, triangles(positions, false), {"bvh6", true, "treelet_breadth_first"});
  const Outcome plain = trace("none", memory, top, true);
  REQUIRE(plain.prefetched.empty());
  const auto names = Registry<Prefetcher>::names();
  REQUIRE(names.size() >= 2);
  for (const std::string& name : names) {
    CAPTURE(name);
    const Outcome a = trace(name, memory, top, true), b = trace(name, memory, top, false);
    CHECK(a.prefetched == b.prefetched);
    CHECK(glint::test::first_difference(a.stats, b.stats) == "");
    CHECK((name == "none") == a.prefetched.empty());
    for (const Address at : a.prefetched) REQUIRE(at < memory.bytes_allocated());
    for (size_t w = 0; w < plain.rays.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const Hit &expected = plain.rays[w][lane].committed, &found = a.rays[w][lane].committed;
        REQUIRE(std::memcmp(&expected.t, &found.t, 12) == 0);
        REQUIRE(expected.instance == found.instance);
        REQUIRE(expected.primitive == found.primitive);
      }
  }
}

TEST_CASE("the treelet prefetcher reads all of the treelet that most lanes are about to visit") {
  Random random{8};
  const Positions positions = soup(random, 3000, 10, 2);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions), {"bvh6", true, "treelet_breadth_first"});
  const Treelets treelets(memory);
  PrefetchQueue queue(512, memory, nullptr);
  const auto prefetcher =
      Registry<Prefetcher>::instance().entry("treelet").make_default({nullptr, queue, memory, 2});
  CHECK(prefetcher->needs_treelets());
  CHECK(prefetcher->treelet_ahead() == kNoTreelet);
  RayState at_root = ray_of(top.address, {0, 0, -20}, {0, 0, 1});
  REQUIRE(begin(at_root, memory));
  RayState below = at_root;
  while (below.bottom_stack_base < 0) {
    const Fetch node = next_fetch(below);
    step(below, memory.find(node.address, node.bytes));
  }
  const TreeletId first = treelets.of(next_fetch(at_root).address),
                  second = treelets.of(next_fetch(below).address);
  REQUIRE(first != second);
  const auto sectors_of = [&](TreeletId treelet) {
    uint64_t bytes = 0;
    treelets.for_each_node(treelet, [&](const Fetch& node) { bytes += node.bytes; });
    return bytes / mem::kSectorBytes;
  };
  prefetcher->entered(0, 0, at_root, 0);
  CHECK(prefetcher->treelet_ahead() == first);
  CHECK(queue.stats().wishes.value() == sectors_of(first));
  prefetcher->entered(1, 5, below, 0);  // one lane each: the treelet stays
  CHECK(prefetcher->treelet_ahead() == first);
  prefetcher->entered(1, 6, below, 0);
  CHECK(prefetcher->treelet_ahead() == second);
  CHECK(queue.stats().wishes.value() == sectors_of(first) + sectors_of(second));
  prefetcher->left(1, 0);
  prefetcher->entered(0, 1, at_root, 0);
  CHECK(prefetcher->treelet_ahead() == first);
}

PolicyChoice<Prefetcher> treelet_prefetcher(const std::string& heuristic) {
  PolicyChoice<Prefetcher> choice("treelet");
  Config config;
  config.add_text("test", "heuristic = \"" + heuristic + "\"");
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<Prefetcher>::instance().entry("treelet").read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  return choice;
}

TEST_CASE("the heuristics of the treelet prefetcher read what their names say") {
  Random random{8};
  const Positions positions = soup(random, 3000, 10, 2);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions), {"bvh6", true, "treelet_breadth_first"});
  RayState at_root = ray_of(top.address, {0, 0, -20}, {0, 0, 1});
  REQUIRE(begin(at_root, memory));
  RayState below = at_root;
  while (below.bottom_stack_base < 0) {
    const Fetch node = next_fetch(below);
    step(below, memory.find(node.address, node.bytes));
  }
  std::vector<Address> sectors;  // of the treelet of the bottom level's root
  const Treelets treelets(memory);
  treelets.for_each_node(treelets.of(next_fetch(below).address), [&](const Fetch& node) {
    for (uint32_t at = 0; at < node.bytes; at += mem::kSectorBytes) sectors.push_back(node.address + at);
  });
  REQUIRE(sectors.size() >= 12);
  // One lane stands at the top, and then `lanes` others below it. Returns what their treelet had read of it.
  const auto reads = [&](const std::string& heuristic, int lanes) {
    PrefetchQueue queue(512, memory, nullptr);
    const auto prefetcher = treelet_prefetcher(heuristic).make({nullptr, queue, memory, 1});
    prefetcher->entered(0, 0, at_root, 0);
    queue.clear();
    for (int lane = 1; lane <= lanes; ++lane) prefetcher->entered(0, lane, below, 0);
    std::vector<Address> out;
    for (; !queue.empty(); queue.note_sent(true)) out.push_back(queue.front());
    return out;
  };
  CHECK(reads("always", 1).empty());  // one lane each
  CHECK(reads("always", 2) == sectors);
  CHECK(reads("popularity", 3).empty());  // 3 of 4 lanes are not more than 75 %.
  CHECK(reads("popularity", 4) == sectors);
  const auto two_thirds = ptrdiff_t((sectors.size() * 2 + 2) / 3), half = ptrdiff_t(sectors.size() / 2);
  CHECK(reads("partial", 2) == std::vector(sectors.begin(), sectors.begin() + two_thirds));
  CHECK(reads("latter_half", 2) == std::vector(sectors.begin() + half, sectors.end()));
}

TEST_CASE("a queue of prefetches loses nothing: each wish is counted where it went") {
  mem::AddressSpace memory;
  const Address at = memory.allocate("nodes", 1024);
  PrefetchQueue queue(4, memory, nullptr);
  const PrefetchQueueStats& stats = queue.stats();
  queue.want(Fetch{at + 8, 64, NodeKind::Internal});  // touches three sectors
  CHECK(queue.size() == 3);
  CHECK(queue.front() == at);
  queue.want(at + 33);
  CHECK(stats.repeated.value() == 1);
  queue.want(Address{12});
  CHECK(stats.outside.value() == 1);
  queue.want(at + 512);
  queue.want(at + 544);
  CHECK(stats.too_many.value() == 1);
  queue.remove(at + 40, 8);
  CHECK(stats.demanded.value() == 1);
  queue.note_sent(false);
  CHECK(queue.front() == at);
  queue.note_sent(true);
  CHECK(queue.front() == at + 64);
  queue.clear();
  CHECK(queue.empty());
  CHECK(stats.dropped.value() == 2);
  CHECK(stats.refused.value() == 1);
  CHECK(stats.wishes.value() == stats.repeated.value() + stats.outside.value() + stats.too_many.value() +
                                    stats.demanded.value() + stats.dropped.value() + stats.sent.value());
}

}  // namespace
}  // namespace glint::rt::test
