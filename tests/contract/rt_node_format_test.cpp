// Tests that every registered node format keeps the promises of rtunit/node_format.h.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>
#include <map>
#include <utility>

#include "base/diagnostics.h"
#include "base/registry.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/validate.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

BuildOptions options_of(const std::string& format, bool pair = true) {
  return {format.c_str(), pair};
}

TEST_CASE("every node format encodes sound structures, the same every time") {
  Random random{6};
  const Positions positions = soup(random, 3000, 10, 1);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    mem::AddressSpace a, b;
    const StructureInfo first = single(a, triangles(positions), options_of(name)),
                        second = single(b, triangles(positions), options_of(name));
    CHECK(validate(a, first.address).empty());
    REQUIRE(first.bytes == second.bytes);
    CHECK(std::memcmp(a.find(first.address, first.bytes), b.find(second.address, second.bytes),
                      first.bytes) == 0);
    const auto format = make_format(name);
    CHECK(format->width() >= 2);
    CHECK(format->node_bytes() % kBlockBytes == 0);
    CHECK(format->walk().node_bytes == format->node_bytes());
  }
}

TEST_CASE("every node format writes the same bytes on one thread and on several") {
  Random random{8};
  const Positions positions = soup(random, 30000, 100, 1);  // more nodes than one thread takes at a time
  const BottomLevel bottom{{triangles(positions)}};
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    const EncodedStructure one = encode_bottom("b", bottom, options_of(name), 1),
                           many = encode_bottom("b", bottom, options_of(name), 5);
    REQUIRE(one.bytes.size() == many.bytes.size());
    CHECK(std::memcmp(one.bytes.data(), many.bytes.data(), one.bytes.size()) == 0);
  }
}

TEST_CASE("a structure's header names its node format by the hash of the format's name") {
  // The hashes are those of the published FNV-1a in 32 bits, so they stay what they are.
  CHECK(format_id("") == 0x811c9dc5);
  CHECK(format_id("a") == 0xe40c292c);
  CHECK(format_id("foobar") == 0xbf9cf968);
  Random random{6};
  const Positions positions = soup(random, 10, 10, 1);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    mem::AddressSpace memory;
    const StructureInfo top = single(memory, triangles(positions), options_of(name));
    CHECK(top.format == format_id(name));
    CHECK(memory.view<StructureHeader>(top.address, 1)[0].format == top.format);
    REQUIRE(find_format(top.format) != nullptr);
    CHECK(find_format(top.format)->node_bytes() == make_format(name)->node_bytes());
  }
}

TEST_CASE("a structure of an unknown node format is refused, by rays and by the validator") {
  Random random{6};
  const Positions positions = soup(random, 10, 10, 1);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions), options_of("bvh6"));
  memory.view<StructureHeader>(top.address, 1)[0].format = format_id("of a plugin that is not loaded");
  CHECK(find_format(format_id("of a plugin that is not loaded")) == nullptr);
  RayState ray = ray_of(top.address, {0, 0, -30}, {0, 0, 1});
  CHECK_FALSE(begin(ray, memory));
  CHECK(ray.status == RayStatus::Done);
  const auto errors = validate(memory, top.address);
  REQUIRE_FALSE(errors.empty());
  CHECK_THAT(errors[0], Catch::Contains("unknown node format 0x"));
}

TEST_CASE("a bottom level of another node format is refused") {
  Random random{6};
  const Positions positions = soup(random, 10, 10, 1);
  mem::AddressSpace memory;
  const StructureInfo bottom = build_bottom(memory, "b", {{triangles(positions)}}, {"bvh2"});
  CHECK_THROWS_WITH(build_top(memory, "t", std::vector<Instance>(1), std::vector{bottom}, {"bvh6"}),
                    Catch::Contains("another node format"));
}

// Width and bytes are as published, and the number of nodes lies between a full tree's and a binary one's.
TEST_CASE("nodes have the published sizes, and a structure is its header, nodes and leaves") {
  const std::map<std::string, std::pair<uint32_t, uint32_t>> known{
      {"bvh2", {2, 64}}, {"bvh4", {4, 128}},       {"bvh6", {6, 64}},
      {"bvh8", {8, 80}}, {"bvh8_12bit", {8, 128}}, {"cwbvh", {8, 80}}};
  Random random{1};
  const Positions positions = soup(random, 1000, 10, 1);
  uint32_t last_depth = 1000, last_width = 0;
  for (const auto& [name, size] : known) {
    CAPTURE(name);
    const auto format = make_format(name);
    CHECK(format->width() == size.first);
    CHECK(format->node_bytes() == size.second);
    mem::AddressSpace memory;
    const StructureInfo info = build_bottom(memory, "b", {{triangles(positions)}}, options_of(name, false));
    CHECK(info.leaves == 1000);
    CHECK(info.nodes >= 999 / (size.first - 1));
    if (name == "bvh2")
      CHECK(info.nodes == 999);
    else
      CHECK(info.nodes < 999 / 2);
    const uint64_t gap = name == "bvh8_12bit" ? 64 : 0;  // The root is no multiple of 128 B from the header.
    const uint64_t nodes_end = 64 + gap + uint64_t(size.second) * info.nodes;
    CHECK(info.bytes == (nodes_end + 63) / 64 * 64 + 64 * 1000);
    CHECK(info.depth < last_depth + (size.first == last_width));  // wider trees are shallower
    last_depth = info.depth, last_width = size.first;
  }
}

// Returns a point of any size. Random::point itself multiplies by 2^24.
std::array<float, 3> scaled_point(Random& random, float size) {
  auto p = random.point(1);
  for (float& x : p) x *= size;
  return p;
}

// The test takes any number of children up to the format's width, of any size and at any place.
TEST_CASE("boxes as decoded contain what they were made of") {
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    Random random{4};
    const auto format = make_format(name);
    for (int round = 0; round < 2000; ++round) {
      BuildTree tree;
      tree.leaf_bytes = mem::HostBlock(kLeafBytes * format->width());
      const float size = std::pow(10.f, random.uniform(-36, 36)),
                  place = size * std::pow(10.f, random.uniform(-2, 6));
      const auto center = scaled_point(random, std::fmin(place, 1e37f));
      const uint32_t children = 1 + random.below(format->width());
      tree.nodes = mem::HostArray<BuildTree::Node>(1 + children);
      tree.children = mem::HostArray<uint32_t>(children);
      tree.nodes[0].num_children = uint8_t(children);
      for (uint32_t i = 0; i < children; ++i) {
        BuildTree::Node leaf;
        leaf.kind = NodeKind::Triangle;
        leaf.leaf_block = i * kLeafBytes / kBlockBytes;
        const auto a = scaled_point(random, size), b = scaled_point(random, size);
        for (size_t k = 0; k < 3; ++k) {
          leaf.bounds.low[k] = center[k] + std::fmin(a[k], b[k]);
          leaf.bounds.high[k] = random.below(8) ? center[k] + std::fmax(a[k], b[k]) : leaf.bounds.low[k];
        }
        tree.nodes[i + 1] = leaf;
        tree.children[i] = i + 1;
      }
      format->arrange(tree, 1);
      const mem::HostBlock bytes = format->encode(tree, format->place(tree, {}), 1);
      std::vector<DecodedChild> decoded(format->width());
      const uint32_t count = format->decode(bytes.data() + kRootBlock * kBlockBytes, decoded);
      REQUIRE(count == tree.nodes[0].num_children);
      for (uint32_t i = 0; i < count; ++i)
        for (size_t k = 0; k < 3; ++k) {
          REQUIRE(decoded[i].bounds.low[k] <= tree.nodes[i + 1].bounds.low[k]);
          REQUIRE(decoded[i].bounds.high[k] >= tree.nodes[i + 1].bounds.high[k]);
        }
    }
  }
}

// In every format the validator must refuse a box that shrinks and a child that is lost.
TEST_CASE("the validator finds damage in every node format") {
  Random random{3};
  const Positions positions = soup(random, 100, 10, 1);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    CAPTURE(name);
    mem::AddressSpace memory;
    const StructureInfo info = build_bottom(memory, "b", {{triangles(positions)}}, options_of(name, false));
    const auto view = memory.view<std::byte>(info.address, info.bytes);
    const uint32_t node_bytes = make_format(name)->node_bytes();
    uint32_t found = 0;
    for (size_t at = 64; at < 64 + node_bytes; ++at) {
      const std::byte before = view[at];
      view[at] = before ^ std::byte{0x48};
      found += !validate(memory, info.address).empty();
      view[at] = before;
    }
    CHECK(validate(memory, info.address).empty());
    // The bytes are changed one by one. Changes of low bits of planes and of padding may go unseen.
    CHECK(found > node_bytes / 4);
  }
}

}  // namespace
}  // namespace glint::rt::test
