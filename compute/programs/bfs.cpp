// Searches a graph breadth-first: two kernels a level, until no node is new.
// SPDX-License-Identifier: Apache-2.0
#include <queue>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

struct Graph {
  std::vector<uint32_t> first, edges;  // the edges of node n are those from first[n] up to first[n + 1]
};

// Gives each node two to four edges, which lead both ways: six a node on average.
Graph random_graph(Random& random, uint32_t nodes) {
  std::vector<std::vector<uint32_t>> of(nodes);
  for (uint32_t node = 0; node < nodes; ++node)
    for (uint32_t left = 2 + random.below(3); left > 0; --left) {
      const uint32_t to = random.below(nodes);
      of[node].push_back(to);
      of[to].push_back(node);
    }
  Graph out{{0}, {}};
  for (const std::vector<uint32_t>& edges : of) {
    out.edges.insert(out.edges.end(), edges.begin(), edges.end());
    out.first.push_back(uint32_t(out.edges.size()));
  }
  return out;
}

std::vector<int32_t> distances_of(const Graph& graph, uint32_t source) {
  std::vector<int32_t> out(graph.first.size() - 1, -1);
  std::queue<uint32_t> open({source});
  out[source] = 0;
  for (; !open.empty(); open.pop()) {
    const uint32_t node = open.front();
    for (uint32_t i = graph.first[node]; i < graph.first[node + 1]; ++i) {
      if (out[graph.edges[i]] >= 0) continue;
      out[graph.edges[i]] = out[node] + 1;
      open.push(graph.edges[i]);
    }
  }
  return out;
}

}  // namespace

void bfs(Host& host, Size size) {
  const uint32_t nodes = size == Size::Full ? 65'536 : 4'096, source = 0;
  const Graph graph = random_graph(host.random, nodes);
  const auto first = host.buffer("first edges", graph.first), edges = host.buffer("edges", graph.edges);
  const auto frontier = host.buffer<uint32_t>("frontier", nodes), next = host.buffer<uint32_t>("next", nodes),
             visited = host.buffer<uint32_t>("visited", nodes), more = host.buffer<uint32_t>("more", 1);
  const auto distance = host.buffer("distances", std::vector<int32_t>(nodes, -1));
  host.view(frontier)[source] = host.view(visited)[source] = 1;
  host.view(distance)[source] = 0;
  const std::array<uint32_t, 3> groups{groups_of(nodes, 256), 1, 1};
  do {
    host.view(more)[0] = 0;
    host.launch("bfs_expand", groups, {first, edges, frontier, next, visited, distance}, nodes);
    host.launch("bfs_advance", groups, {frontier, next, visited, more}, nodes);
  } while (host.view(more)[0] != 0);
  host.check("distances", distance, distances_of(graph, source));
}

}  // namespace glint::compute
