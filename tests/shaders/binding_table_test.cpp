// Tests binding tables: where records lie, what they hold, what they call, and what a host may not ask for.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/binding_table.h"

#include <algorithm>

#include "base/diagnostics.h"
#include "tests/shaders/ray_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using Catch::Contains;

// Has shaders 0 to 4: ray generation, miss, closest-hit, intersection, callable. Each has a group, and the
// fourth group has both hit shaders.
struct Bench {
  exec::World world;
  mem::AddressSpace memory;
  exec::Image image =
      exec::link({compile_lab("table.rgen"), compile_lab("table.rmiss"), compile_lab("tag1.rchit"),
                  compile_lab("pair.rint"), compile_lab("rt/twice.rcall")});
  pipeline::TableInput input;

  Bench() {
    world.image = &image;
    world.memory = &memory;
    input.groups = {{0, {}},
                    {1, {}},
                    {exec::kNoShader, {2, exec::kNoShader, exec::kNoShader}},
                    {exec::kNoShader, {2, exec::kNoShader, 3}},
                    {4, {}}};
    input.raygen = {0, data(1)};
    input.miss.records = {{1, {}}, {}};
    input.hit.records = {{2, data(8)}, {3, data(40)}, {}};
    input.callable.records = {{4, {}}};
  }
  static std::vector<std::byte> data(size_t bytes) { return std::vector<std::byte>(bytes, std::byte(bytes)); }
  std::string error() {
    try {
      pipeline::build_binding_table(world, memory, input);
    } catch (const UserError& error) {
      return error.what();
    }
    return "no error";
  }
  uint32_t word(Address at) { return memory.view<uint32_t>(at, 1)[0]; }
};

TEST_CASE(
    "records lie at the smallest stride that holds the largest of their region, handle first, data behind "
    "it") {
  Bench b;
  REQUIRE(b.error() == "no error");
  const exec::BindingTable& t = b.world.table;
  CHECK(t.miss.stride == 32);
  CHECK(t.hit.stride == 96);
  for (const Address base : {t.raygen, t.miss.base, t.hit.base, t.callable.base}) CHECK(base % 64 == 0);
  CHECK(b.word(t.raygen + 32) % 256 == 1);
  CHECK(b.word(t.hit.address(0) + 32 + 4) == 0x08080808);
  CHECK(b.word(t.hit.address(1) + 32 + 36) == 0x28282828);
  CHECK(b.word(t.hit.address(0)) != b.word(t.hit.address(1)));  // handles
  CHECK(b.word(t.hit.address(2)) == 0);
  CHECK(b.world.raygen == 0);
  CHECK(b.world.miss == std::vector<uint32_t>{1, exec::kNoShader});
  CHECK(b.world.hit[0].intersection == exec::kNoShader);
  CHECK(b.world.hit[1].intersection == 3);
  CHECK(b.world.hit[2].closest_hit == exec::kNoShader);
  CHECK(b.world.callable == std::vector<uint32_t>{4});
}

TEST_CASE("a stride of 0 means the first record at every index, and a wider one spreads them") {
  Bench b;
  b.input.hit.stride = 0;
  b.input.miss.stride = 4096;
  REQUIRE(b.error() == "no error");
  CHECK(b.world.table.hit.number(7) == 0);
  CHECK(b.world.table.hit.address(7) == b.world.table.hit.base);
  CHECK(b.world.table.miss.address(1) == b.world.table.miss.base + 4096);
}

TEST_CASE("a table that no host may ask for is refused with the record's name") {
  Bench b;
  SECTION("a stride that is not a multiple of the handle's alignment") {
    b.input.hit.stride = 100;
    CHECK_THAT(b.error(), Contains("the stride of the hit region is 100: it must be a multiple of 32"));
  }
  SECTION("a stride below the largest record") {
    b.input.hit.stride = 64;
    CHECK_THAT(b.error(), Contains("the stride of the hit region is 64, and its largest record needs 96"));
  }
  SECTION("a record beyond the largest stride") {
    b.input.callable.records[0].data = Bench::data(4096);
    CHECK_THAT(b.error(), Contains("a callable record has 4096 bytes"));
  }
  SECTION("a group that there is not") {
    b.input.hit.records[1].group = 5;
    CHECK_THAT(b.error(), Contains("hit record 1 names group 5, and there are 5"));
  }
  SECTION("a hit group as a miss record") {
    b.input.miss.records[1].group = 2;
    CHECK_THAT(b.error(), Contains("miss record 1 names group 2, which is a hit group"));
  }
  SECTION("a general group as a hit record") {
    b.input.hit.records[0].group = 1;
    CHECK_THAT(b.error(), Contains("hit record 0 names group 1, which is not a hit group"));
  }
  SECTION("a shader of another stage") {
    b.input.callable.records[0].group = 1;
    CHECK_THAT(b.error(),
               Contains("callable record 0 wants a shader of stage callable") && Contains("of stage miss"));
  }
}

TEST_CASE("the stack of a lane holds the deepest chain of frames that the depths allow") {
  Bench b;
  const auto bytes = [&](size_t shader) { return b.image.shaders[shader].local_bytes; };
  const uint32_t called = std::max({bytes(1), bytes(2), bytes(3)});
  CHECK(pipeline::stack_bytes(b.image, 0, 0) == (bytes(0) + 15) / 16 * 16);
  CHECK(pipeline::stack_bytes(b.image, 1, 0) == (bytes(0) + called + 15) / 16 * 16);
  CHECK(pipeline::stack_bytes(b.image, 3, 2) ==
        (bytes(0) + called + 2 * std::max(bytes(1), bytes(2)) + 2 * bytes(4) + 15) / 16 * 16);
}

}  // namespace
}  // namespace glint::test
