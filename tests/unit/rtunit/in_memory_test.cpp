// Tests structures in memory of a program: sizes known beforehand, instances by address, copies, serial form.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/in_memory.h"

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/registry.h"
#include "rtunit/structure/validate.h"
#include "rtunit/tree_layout.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

using Catch::Contains;

constexpr std::array<uint8_t, 16> kDriver{1, 2, 3};

DeviceInstance instance_at(Address bottom, float x) {
  DeviceInstance out;
  out.transform[3] = x;
  out.custom_index_and_mask = 0xff00'0007;
  out.structure = bottom;
  return out;
}

// Returns the instance that a ray along -z at x meets, or -1.
int met(const mem::AddressSpace& memory, Address top, float x) {
  RayState state = ray_of(top, {x + 0.25f, 0.25f, 5}, {0, 0, -1});
  if (!begin(state, memory)) return -2;
  run(state, memory);
  return state.committed.valid()
             ? int(load<InstanceLeaf>(memory.find(state.committed.instance_leaf, sizeof(InstanceLeaf)))
                       .instance)
             : -1;
}

// Holds a triangle at the origin and a top level with it at x = 0, 10 and 20.
struct Three {
  mem::AddressSpace memory;
  Positions corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  StructureInfo bottom = build_bottom(memory, "triangle", {{triangles(corners)}});
  std::vector<std::string> notes;
  StructureInfo top =
      place(memory, "top",
            encode_top(memory, "top",
                       std::vector{instance_at(bottom.address, 0), instance_at(bottom.address, 10),
                                   instance_at(bottom.address, 20)},
                       {}, notes));
};

TEST_CASE("no structure is larger than the bound that is known before its geometry") {
  Random random{3};
  for (const std::string& format : Registry<NodeFormat>::names())
    for (const std::string& layout : Registry<TreeLayout>::names())
      for (const uint32_t count : {0u, 1u, 2u, 3u, 9u, 700u}) {
        INFO(format << " " << layout << " " << count);
        const BuildOptions options{format.c_str(), false, layout.c_str()};
        const Positions positions = soup(random, count, 10, 1);
        const EncodedStructure bottom = encode_bottom("b", {{triangles(positions)}}, options);
        CHECK(bottom.bytes.size() <= most_bytes(0, count, options));
        mem::AddressSpace memory;
        const Positions one{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        const StructureInfo below = build_bottom(memory, "b", {{triangles(one)}}, options);
        std::vector<Instance> instances(count);
        for (Instance& each : instances) each.transform = random_transform(random, 1, 50);
        CHECK(encode_top("t", instances, std::vector{below}, options).bytes.size() <=
              most_bytes(1, count, options));
      }
  // In a binary tree every bound is met, but for the room that aligned nodes may need.
  const Positions positions = soup(random, 100, 10, 1);
  const BuildOptions binary{"bvh2", false};
  const EncodedStructure bottom = encode_bottom("b", {{triangles(positions)}}, binary);
  CHECK(most_bytes(0, 100, binary) == bottom.bytes.size() + make_format("bvh2")->node_bytes() + kLeafBytes);
}

TEST_CASE("a top level over addresses has the bytes of one over structures that were built") {
  Three three;
  CHECK(three.notes.empty());
  std::vector<Instance> instances(3);
  for (size_t i = 0; i < 3; ++i) instances[i].transform[3] = 10 * float(i), instances[i].custom_index = 7;
  const EncodedStructure plain = encode_top("t", instances, std::vector{three.bottom});
  REQUIRE(plain.bytes.size() == three.top.bytes);
  CHECK(std::memcmp(plain.bytes.data(), three.memory.find(three.top.address, plain.bytes.size()),
                    plain.bytes.size()) == 0);
  const auto info = structure_at(three.memory, three.top.address);
  REQUIRE(info);
  CHECK(info->bytes == three.top.bytes);
  CHECK(info->stack_need == three.top.stack_need);
  CHECK(info->primitives == 3);
  CHECK(info->bounds == three.top.bounds);
  CHECK_FALSE(structure_at(three.memory, three.top.address + 64).has_value());
  CHECK_FALSE(structure_at(three.memory, 12345).has_value());
}

TEST_CASE("instances that no ray can enter, and those of nothing, are inactive and noted") {
  Three three;
  std::vector<DeviceInstance> instances(6, instance_at(three.bottom.address, 0));
  instances[1].transform = {};                 // It maps everything to a point.
  instances[2].structure = 0;                  // This one is inactive, without a note.
  instances[3].structure = three.top.address;  // This is not a bottom level.
  instances[4].structure = Address{77} << 32;
  instances[5].transform[3] = 30;
  std::vector<std::string> notes;
  const StructureInfo top = place(three.memory, "t", encode_top(three.memory, "t", instances, {}, notes));
  CHECK(top.primitives == 2);
  CHECK(met(three.memory, top.address, 0) == 0);
  CHECK(met(three.memory, top.address, 30) == 5);
  REQUIRE(notes.size() == 3);
  CHECK_THAT(notes[0], Contains("instance 3: no bottom level of this node format is at address"));
  CHECK_THAT(notes[1],
             Contains("instance 4: no bottom level of this node format is at address 0x4d00000000"));
  CHECK_THAT(notes[2], Contains("instance 1: its transform cannot be inverted"));
  CHECK(validate(three.memory, top.address).empty());
}

TEST_CASE("a structure is written into memory of a program, and a copy is as good as it was") {
  Three three;
  const mem::Backing backing = three.memory.add_backing(4096);
  const Address room = three.memory.open_window("room", backing, 0, 4096);
  copy_structure(three.memory, three.top.address, room + 256);
  three.memory.free(three.top.address);
  CHECK(met(three.memory, room + 256, 10) == 1);
  CHECK(validate(three.memory, room + 256).empty());
  const EncodedStructure again = encode_bottom("b", {{triangles(three.corners)}});
  write_structure(three.memory, again, room + 2048);
  CHECK(structure_at(three.memory, room + 2048)->bytes == again.bytes.size());
  CHECK_THROWS_WITH(write_structure(three.memory, again, room + 4096 - 64), Contains("has no room"));
  CHECK_THROWS_WITH(write_structure(three.memory, again, room + 8), Contains("not a multiple of 64"));
  CHECK_THROWS_WITH(copy_structure(three.memory, room + 3008, room), Contains("no acceleration structure"));
}

TEST_CASE("a serialised structure comes back with the bottom levels that its list names then") {
  Three three;
  CHECK(bottoms_of(three.memory, three.top.address) == std::vector<Address>(3, three.bottom.address));
  CHECK(bottoms_of(three.memory, three.bottom.address).empty());
  CHECK(serial_bytes(three.memory, three.top.address) == 56 + 3 * 8 + three.top.bytes);
  std::vector<std::byte> serial(serial_bytes(three.memory, three.top.address)),
      below(serial_bytes(three.memory, three.bottom.address));
  serialize(three.memory, three.top.address, kDriver, serial);
  serialize(three.memory, three.bottom.address, kDriver, below);
  const auto header = load<SerialHeader>(serial.data());
  CHECK(header.driver == kDriver);
  CHECK(header.serial_bytes == serial.size());
  CHECK(header.bytes == three.top.bytes);

  mem::AddressSpace other;
  other.allocate("something else", 100);
  const Address bottom = other.allocate("bottom", three.bottom.bytes),
                top = other.allocate("top", three.top.bytes);
  deserialize(other, below, bottom);
  for (size_t i = 0; i < 3; ++i) std::memcpy(serial.data() + 56 + 8 * i, &bottom, 8);
  deserialize(other, serial, top);
  CHECK(validate(other, top).empty());
  for (int i = 0; i < 3; ++i) CHECK(met(other, top, 10 * float(i)) == i);
}

TEST_CASE("damaged serial bytes are refused or give a structure, and nothing else happens") {
  Three three;
  std::vector<std::byte> serial(serial_bytes(three.memory, three.top.address));
  serialize(three.memory, three.top.address, kDriver, serial);
  const Address room = three.memory.allocate("room", 4096);
  for (size_t bytes = 0; bytes < serial.size(); ++bytes)
    CHECK_THROWS_AS(deserialize(three.memory, std::span(serial).subspan(0, bytes), room), UserError);
  CHECK_THROWS_WITH(deserialize(three.memory, serial, room + 4032), Contains("has no room"));
  auto older = serial;
  older[31] = std::byte{0};
  CHECK_THROWS_WITH(deserialize(three.memory, older, room), Contains("another version"));
  Random random{11};
  for (const std::string& format : Registry<NodeFormat>::names()) {
    CAPTURE(format);
    const BuildOptions options{format.c_str()};
    mem::AddressSpace memory;
    const StructureInfo bottom = build_bottom(memory, "b", {{triangles(three.corners)}}, options);
    std::vector<Instance> instances(40);
    for (Instance& each : instances) each.transform = random_transform(random, 1, 50);
    const StructureInfo top = build_top(memory, "t", instances, std::vector{bottom}, options);
    std::vector<std::byte> sound(serial_bytes(memory, top.address));
    serialize(memory, top.address, kDriver, sound);
    const Address to = memory.allocate("room", top.bytes);
    int refused = 0;
    for (int i = 0; i < 500; ++i) {
      auto damaged = sound;
      for (int k = 0; k < 20; ++k)
        damaged[random.below(uint32_t(damaged.size()))] = std::byte(random.below(256));
      try {
        deserialize(memory, damaged, to);
      } catch (const UserError&) {
        ++refused;
      }
    }
    CHECK(refused > 50);
  }
}

// Each instance is as far away as all before it together, which makes the tree over areas a list.
TEST_CASE("a tree that is too deep for the ray stack is built anew, balanced") {
  mem::AddressSpace memory;
  const Positions corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  StructureInfo bottom = build_bottom(memory, "b", {{triangles(corners)}}, {"bvh2"});
  std::vector<Instance> instances(60);
  for (size_t i = 0; i < instances.size(); ++i) {
    const float scale = std::ldexp(1.0f, int(i));
    instances[i].transform = {scale, 0, 0, 2 * scale, 0, scale, 0, 0, 0, 0, scale, 0};
  }
  const uint32_t deep = encode_top("t", instances, std::vector{bottom}, {"bvh2"}).info.stack_need;
  CHECK(deep > 20);
  bottom.stack_need = uint32_t(kStackEntries) - deep + bottom.stack_need + 1;
  const EncodedStructure flat = encode_top("t", instances, std::vector{bottom}, {"bvh2"});
  CHECK(flat.info.stack_need == 6 + bottom.stack_need);  // 60 leaves are 6 levels of a binary tree deep.
  CHECK(flat.info.depth == 6);
  const StructureInfo top = build_top(memory, "t", instances, std::vector{bottom}, {"bvh2"});
  CHECK(validate(memory, top.address).empty());
  CHECK(bottoms_of(memory, top.address).size() == 60);
  bottom.stack_need = uint32_t(kStackEntries);
  CHECK_THROWS_WITH(encode_top("t", instances, std::vector{bottom}, {"bvh2"}),
                    Contains("even in a balanced tree"));
}

}  // namespace
}  // namespace glint::rt::test
