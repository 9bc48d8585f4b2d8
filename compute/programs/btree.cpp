// Looks up keys and ranges of keys in a B+ tree of nodes with 256 keys.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

constexpr uint32_t kOrder = 256;
constexpr int32_t kNoKey = std::numeric_limits<int32_t>::max();

struct Tree {
  std::vector<int32_t> keys;    // kOrder a node; kNoKey behind the last one
  std::vector<uint32_t> below;  // node, or number of the record
  uint32_t root = 0, height = 0;
};

// Packs ascending keys into nodes, level after level from the leaves up.
Tree tree_of(const std::vector<int32_t>& keys) {
  Tree out;
  std::vector<int32_t> level = keys;
  std::vector<uint32_t> targets(level.size());
  for (uint32_t i = 0; i < targets.size(); ++i) targets[i] = i;
  do {
    std::vector<int32_t> firsts;
    std::vector<uint32_t> nodes;
    for (size_t i = 0; i < level.size(); ++i) {
      if (i % kOrder == 0) {
        firsts.push_back(level[i]);
        nodes.push_back(uint32_t(out.keys.size() / kOrder));
        out.keys.resize(out.keys.size() + kOrder, kNoKey);
        out.below.resize(out.keys.size());
      }
      const size_t at = size_t(nodes.back()) * kOrder + i % kOrder;
      out.keys[at] = level[i], out.below[at] = targets[i];
    }
    level = std::move(firsts), targets = std::move(nodes);
    ++out.height;
  } while (level.size() > 1);
  out.root = targets[0];
  return out;
}

struct Range {
  int32_t before, last;  // all keys above the first and up to the second
};

// Returns the number of keys up to `key`, by a binary search.
uint32_t rank(const std::vector<int32_t>& keys, int32_t key) {
  return uint32_t(std::upper_bound(keys.begin(), keys.end(), key) - keys.begin());
}

}  // namespace

void btree(Host& host, Size size) {
  const bool full = size == Size::Full;
  const uint32_t count = full ? 1'000'000 : 20'000, num_queries = full ? 10'000 : 200,
                 num_ranges = full ? 6'000 : 120, most = 3'000;
  std::vector<int32_t> keys(count), records(count), queries(num_queries);
  for (uint32_t i = 1; i < count; ++i) keys[i] = keys[i - 1] + 1 + int32_t(host.random.below(3));
  for (int32_t& record : records) record = int32_t(host.random.below(1u << 30));
  const uint32_t end = uint32_t(keys.back()) + 1;
  for (int32_t& query : queries) query = int32_t(host.random.below(end));
  std::vector<Range> ranges(num_ranges);
  for (Range& range : ranges) {
    range.before = int32_t(host.random.below(end - most));
    range.last = range.before + int32_t(host.random.below(most));
  }
  const Tree tree = tree_of(keys);
  const auto nodes = host.buffer("keys", tree.keys);
  const auto below = host.buffer("below", tree.below);
  const auto answers = host.buffer<int32_t>("answers", num_queries);
  const auto found = host.buffer<uint32_t>("found", num_ranges * 2);
  struct {
    uint32_t root, height;
  } const constants{tree.root, tree.height};
  host.launch("btree_find", {num_queries, 1, 1},
              {nodes, below, host.buffer("queries", queries), host.buffer("records", records), answers},
              constants);
  host.launch("btree_range", {num_ranges, 1, 1}, {nodes, below, host.buffer("ranges", ranges), found},
              constants);
  std::vector<int32_t> expected;
  for (const int32_t query : queries) {
    const uint32_t at = rank(keys, query) - 1;  // The first key is 0.
    expected.push_back(keys[at] == query ? records[at] : -1);
  }
  host.check("answers", answers, expected);
  std::vector<uint32_t> counts;
  for (const Range& range : ranges) {
    const uint32_t first = rank(keys, range.before);
    counts.insert(counts.end(), {first, rank(keys, range.last) - first});
  }
  host.check("found", found, counts);
}

}  // namespace glint::compute
